#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "jobs/bench/cases.hpp"
#include "jobs/bench/comparison.hpp"
#include "jobs/bench/measure.hpp"

namespace semigeo::jobs {

/// Says what is measured, and for how long.
struct SessionSettings {
  bool quick = false;             ///< About 10 seconds instead of a minute.
  std::string filter;             ///< A regular expression that names must contain; empty: all.
  int threads = 0;                ///< The larger number of threads; 0: one for each usable core.
  std::filesystem::path scan;     ///< Takes the place of the built-in scan; may be empty.
  std::filesystem::path program;  ///< The program `semigeo`.
  std::filesystem::path folder;   ///< Where all files are made.
  int machine_cores = 1;          ///< Cores of the machine.
  /// See MeasureSettings::progress.
  std::function<bool(int done, int total, const std::string& name)> progress = {};
};

/// Measures the chosen cases, and again those that seem to have fallen.
class BenchSession {
 public:
  /// Throws std::invalid_argument if the filter is no regular expression, or no name has it. Makes
  /// no file yet.
  explicit BenchSession(const SessionSettings& settings);

  /// Returns the full names of the chosen cases. Those of the machine are always chosen, because
  /// bounds depend on them.
  std::vector<std::string> names() const;

  /// Measures all chosen cases.
  Measurement measure();

  /// Measures figures again that seem to have fallen below the bound, for at most a fifth of the
  /// time, and adds what comes to `measurement`. Returns those that fell again: what was slow for
  /// some seconds only has not fallen.
  std::vector<ComparedRate> confirm(Measurement& measurement, const std::vector<NamedRate>& before,
                                    double bound);

 private:
  Measurement measure(const std::vector<BenchCase>& cases, double seconds);

  SessionSettings settings_;
  WorkerSets workers_;  ///< Before the cases, which keep them.
  std::vector<BenchCase> cases_;
};

}  // namespace semigeo::jobs
