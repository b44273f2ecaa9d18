#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace semigeo::jobs {

/// Describes the machine that figures belong to.
struct MachineDescription {
  std::string host;
  std::string processor;           ///< Its name, as Linux says it.
  int machine_cores = 0;           ///< Cores of the whole machine.
  int usable_cores = 0;            ///< Cores that this process may use.
  std::uint64_t usable_bytes = 0;  ///< Memory that this process can get.
  std::string system;              ///< Name and release of the kernel.
  std::string temporary_folder;
  std::string file_system;  ///< Kind of the file system of that folder: "ext", "tmpfs", ...
};

/// Describes this machine. `root` is the folder in which /proc is found.
MachineDescription describe_machine(const std::filesystem::path& temporary_folder,
                                    const std::filesystem::path& root = "/");

/// Holds what all cores of the machine have done since it was started, in core seconds.
struct MachineTimes {
  double busy = 0;    ///< Time in which they ran something.
  double stolen = 0;  ///< Time in which a hypervisor gave them to others.
};

/// Reads these times; all zero if Linux does not say.
MachineTimes machine_times(const std::filesystem::path& root = "/");

/// Returns the seconds that threads of this process, those that still run, were ready to run and
/// waited for a core; nothing if Linux does not say.
std::optional<double> seconds_in_queue(const std::filesystem::path& root = "/");

/// Returns the number of processes that wanted to run in the last minute, on average; 0 if Linux
/// does not say.
double load_average(const std::filesystem::path& root = "/");

/// Says how busy the machine was with other work while figures were measured.
struct MachineLoad {
  double load_before = 0;  ///< Load average before.
  double load_after = 0;
  double other_cores = 0;       ///< Cores that other processes used, on average.
  double most_other_cores = 0;  ///< The largest such mean while one figure was measured.
  std::string most_name = {};   ///< The full name of that figure.
  double stolen = 0;  ///< Share of the time of all cores that a hypervisor gave to others.

  /// Returns whether other processes may have made figures worse.
  bool was_busy() const { return other_cores > 0.2 || stolen > 0.02; }
};

}  // namespace semigeo::jobs
