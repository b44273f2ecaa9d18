#pragma once

#include <array>
#include <string_view>

namespace semigeo::jobs::cli {

// The exit codes of every command.
inline constexpr int kAllDone = 0;        ///< All jobs are done, or were up to date.
inline constexpr int kSomeFailed = 1;     ///< Some jobs have failed.
inline constexpr int kUsage = 2;          ///< The command line is wrong.
inline constexpr int kLocked = 73;        ///< Another run has the archive.
inline constexpr int kStoppedEarly = 75;  ///< The run was stopped before all jobs had ended.

/// An exit code, and what it means to people.
struct ExitCode {
  int code;
  std::string_view meaning;
};

/// All exit codes, as pages and man pages have them.
inline constexpr std::array<ExitCode, 5> kExitCodes = {{
    {kAllDone, "all done"},
    {kSomeFailed,
     "some jobs failed, a folder could not be searched, something is broken, or results could not "
     "be printed"},
    {kUsage, "the command line or the configuration is wrong; nothing was done"},
    {kLocked, "another run has the archive"},
    {kStoppedEarly, "stopped early, by a signal, a time limit or a disk; run again to go on"},
}};

/// A variable of the environment that the program reads, and what it does.
struct EnvironmentVariable {
  std::string_view name;
  std::string_view meaning;
};

/// All variables, as pages and man pages have them.
inline constexpr std::array<EnvironmentVariable, 6> kEnvironment = {{
    {"COLUMNS",
     "the width of help and of the line of progress; without it, that of the terminal, or 80"},
    {"NO_COLOR", "needs no effect: nothing is printed in colours"},
    {"PATH", "where sbatch, squeue and scancel are found"},
    {"SEMIGEO_SIMD",
     "the instruction set that traces patches: scalar, baseline, avx2 or avx512; without it, the "
     "fastest one that the CPU has; no byte of a result depends on it"},
    {"TERM", "on a terminal that is dumb, progress is printed in plain lines"},
    {"TMPDIR", "the folder for files that are not kept; without it, /tmp"},
}};

}  // namespace semigeo::jobs::cli
