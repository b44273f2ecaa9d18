#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "jobs/bench/figure.hpp"
#include "jobs/bench/machine.hpp"
#include "jobs/bench/schedule.hpp"

namespace semigeo::jobs {

/// Says how cases are measured.
struct MeasureSettings {
  RepetitionLimits repetitions;  ///< `seconds` counts from the first preparation.
  double least_seconds = 0.03;   ///< A repetition of a fast case has calls for so much time.
  int machine_cores = 1;
  /// Is told before each repetition how many are done, how many there are (0: not known yet), and
  /// which comes. If it returns false, nothing more is measured.
  std::function<bool(int done, int total, const std::string& name)> progress = {};
};

/// Holds what was measured.
struct Measurement {
  std::vector<Figure> figures;  ///< figures[i] belongs to case i.
  MachineLoad load;
  bool complete = true;  ///< If false, somebody asked to stop.
};

/// Holds one set of threads for each number of threads.
class WorkerSets {
 public:
  /// Returns the set of so many threads. It lives as long as this object.
  engine::Workers& of(int threads);

 private:
  std::map<int, std::unique_ptr<engine::Workers>> sets_;
};

/// Measures cases. Each is called to warm up, which is not counted, then repetition by repetition
/// in the order of `interleaved`. Bounds are found at the end. Throws what a case throws.
///
/// Cases may keep the workers that they are called with: `workers` must live as long as the cases.
Measurement measure(std::span<const BenchCase> cases, WorkerSets& workers,
                    const MeasureSettings& settings);

}  // namespace semigeo::jobs
