#include "jobs/bench/measure.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

namespace semigeo::jobs {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Holds what this process and the children that it has waited for have used.
struct Usage {
  double cpu_seconds = 0;
  double disk_bytes = 0;
};

Usage usage_now() {
  constexpr double kBlock = 512;  // getrusage(2) counts in such blocks
  Usage sum;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& t : {usage.ru_utime, usage.ru_stime})
      sum.cpu_seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    sum.disk_bytes += kBlock * static_cast<double>(usage.ru_inblock + usage.ru_oublock);
  }
  return sum;
}

/// Watches the machine from now on.
class MachineWatch {
 public:
  /// Returns the cores that other processes have used, on average.
  double other_cores() const {
    const double cores =
        machine_times().busy - times_.busy - usage_now().cpu_seconds + usage_.cpu_seconds;
    return std::max(0.0, cores / std::max(seconds(), 1e-6));
  }
  /// Returns the cores that a hypervisor has given to others, on average.
  double stolen_cores() const {
    return (machine_times().stolen - times_.stolen) / std::max(seconds(), 1e-6);
  }
  double seconds() const { return seconds_since(start_); }

 private:
  Clock::time_point start_ = Clock::now();
  MachineTimes times_ = machine_times();
  Usage usage_ = usage_now();
};

/// Calls a case and adds what that took to a repetition. Its preparation is not counted.
void call(const BenchCase& bench, engine::Workers& workers, BenchRepetition& sum) {
  if (bench.prepare) bench.prepare(workers);
  const std::optional<double> queued_before = seconds_in_queue();
  const Usage before = usage_now();
  const Clock::time_point start = Clock::now();
  const BenchWork work = bench.run(workers);
  sum.seconds += seconds_since(start);
  const Usage after = usage_now();
  const std::optional<double> queued = seconds_in_queue();
  if (bench.in_children || !queued || !queued_before || !sum.queued_seconds)
    sum.queued_seconds.reset();
  else
    *sum.queued_seconds += std::max(0.0, *queued - *queued_before);
  ++sum.calls;
  sum.cpu_seconds += after.cpu_seconds - before.cpu_seconds;
  sum.disk_bytes += after.disk_bytes - before.disk_bytes;
  sum.work.amount += work.amount;
  sum.work.vertex_levels += work.vertex_levels;
  sum.work.memory_bytes += work.memory_bytes;
  sum.work.locked_seconds += work.locked_seconds;
}

BenchRepetition repeat(const BenchCase& bench, engine::Workers& workers, int calls) {
  BenchRepetition repetition;
  const MachineWatch watch;
  for (int i = 0; i < calls; ++i) call(bench, workers, repetition);
  repetition.other_cores = watch.other_cores();
  return repetition;
}

/// Says how often a case is called in a repetition, and what that costs with its preparation.
struct Calibration {
  int calls = 1;
  double seconds = 0;
};

Calibration calibrate(const BenchCase& bench, engine::Workers& workers, double least_seconds) {
  constexpr double kLong = 5;  // a first call of so many repetitions is warm for most of its time
  Clock::time_point start = Clock::now();
  double seconds = repeat(bench, workers, 1).seconds;
  if (seconds < kLong * least_seconds) {
    start = Clock::now();
    seconds = repeat(bench, workers, 1).seconds;
  }
  const double whole = seconds_since(start);
  // Preparation that takes longer than the work must not be repeated for ever.
  const double calls = std::ceil(std::min(least_seconds / std::max(seconds, 1e-6),
                                          kLong * least_seconds / std::max(whole, 1e-6)));
  const int count = static_cast<int>(std::clamp(calls, 1.0, 1e6));
  return {.calls = count, .seconds = count * whole};
}

/// Fills in what was measured of the machine as a whole.
void summarise(Measurement& measurement, const MachineWatch& watch, int machine_cores) {
  MachineLoad& load = measurement.load;
  load.load_after = load_average();
  load.other_cores = watch.other_cores();
  load.stolen = watch.stolen_cores() / machine_cores;
  for (const Figure& figure : measurement.figures) {
    const double others = figure.other_cores();
    if (others <= load.most_other_cores) continue;
    load.most_other_cores = others;
    load.most_name = figure.full_name();
  }
}

}  // namespace

engine::Workers& WorkerSets::of(int threads) {
  std::unique_ptr<engine::Workers>& workers = sets_[threads];
  if (!workers) workers = std::make_unique<engine::Workers>(threads);
  return *workers;
}

Measurement measure(std::span<const BenchCase> cases, WorkerSets& workers,
                    const MeasureSettings& settings) {
  const MachineWatch watch;
  Measurement measurement;
  measurement.load.load_before = load_average();
  const auto goes_on = [&](std::size_t done, std::size_t total, const std::string& name) {
    if (settings.progress && measurement.complete)
      measurement.complete =
          settings.progress(static_cast<int>(done), static_cast<int>(total), name);
    return measurement.complete;
  };
  std::vector<Calibration> calibrations;
  std::vector<double> costs;
  for (const BenchCase& bench : cases) {
    measurement.figures.push_back(
        {.name = bench.name, .unit = bench.unit, .threads = bench.threads});
    if (!goes_on(0, 0, measurement.figures.back().full_name())) return measurement;
    calibrations.push_back(calibrate(bench, workers.of(bench.threads), settings.least_seconds));
    costs.push_back(calibrations.back().seconds);
  }
  RepetitionLimits limits = settings.repetitions;
  limits.seconds -= watch.seconds();
  const std::vector<int> order = interleaved(costs, limits);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const BenchCase& bench = cases[order[k]];
    Figure& figure = measurement.figures[order[k]];
    if (!goes_on(k, order.size(), figure.full_name())) return measurement;
    figure.repetitions.push_back(
        repeat(bench, workers.of(bench.threads), calibrations[order[k]].calls));
  }
  find_bounds(measurement.figures, settings.machine_cores);
  summarise(measurement, watch, settings.machine_cores);
  return measurement;
}

}  // namespace semigeo::jobs
