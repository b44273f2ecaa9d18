#include "jobs/bench/figure.hpp"

#include <algorithm>

namespace semigeo::jobs {
namespace {

const Figure* find(const std::vector<Figure>& figures, const std::string& name, int threads) {
  const auto at = std::ranges::find_if(figures, [&](const Figure& figure) {
    return figure.name == name && figure.threads == threads;
  });
  return at == figures.end() ? nullptr : &*at;
}

BoundEvidence evidence_of(const Figure& figure, const std::vector<Figure>& figures,
                          int machine_cores) {
  const double seconds = figure.total(&BenchRepetition::seconds);
  if (seconds <= 0) return {};
  BoundEvidence evidence = {.threads = figure.threads,
                            .busy = figure.total(&BenchRepetition::cpu_seconds) / seconds,
                            .locked = figure.total(&BenchWork::locked_seconds) / seconds,
                            .disturbed = figure.was_disturbed(machine_cores),
                            .used_disk = figure.total(&BenchRepetition::disk_bytes) > 0};
  if (const Figure* memory = find(figures, "machine/memory", figure.threads);
      memory != nullptr && memory->rate().median > 0)
    evidence.memory =
        figure.total(&BenchWork::memory_bytes) / seconds / (1e9 * memory->rate().median);
  const Figure* alone = figure.threads > 1 ? find(figures, figure.name, 1) : nullptr;
  if (alone != nullptr && alone->rate().median > 0) {
    evidence.speedup = figure.rate().median / alone->rate().median;
    const BoundEvidence of_one = evidence_of(*alone, figures, machine_cores);
    evidence.alone_on_disk = bound_of(of_one) == Bound::kDisk;
  }
  return evidence;
}

}  // namespace

Spread Figure::rate() const {
  std::vector<double> rates;
  for (const BenchRepetition& repetition : repetitions) rates.push_back(repetition.rate());
  return spread_of(rates);
}

double Figure::microseconds_per_vertex_level() const {
  std::vector<double> times;
  for (const BenchRepetition& repetition : repetitions)
    if (repetition.work.vertex_levels > 0)
      times.push_back(1e6 * repetition.seconds / repetition.work.vertex_levels);
  return median_of(times);
}

double Figure::cpu_rate() const {
  std::vector<double> rates;
  for (const BenchRepetition& repetition : repetitions)
    if (repetition.cpu_seconds > 0)
      rates.push_back(repetition.work.amount / repetition.cpu_seconds);
  return median_of(rates);
}

double Figure::missing_cores(int machine_cores) const {
  double queued = 0;
  for (const BenchRepetition& repetition : repetitions) {
    if (!repetition.queued_seconds) return std::max(0.0, threads + other_cores() - machine_cores);
    queued += *repetition.queued_seconds;
  }
  const double seconds = total(&BenchRepetition::seconds);
  return seconds > 0 ? queued / seconds : 0;
}

double Figure::other_cores() const {
  double core_seconds = 0;
  double seconds = 0;
  for (const BenchRepetition& repetition : repetitions) {
    core_seconds += repetition.other_cores * repetition.seconds;
    seconds += repetition.seconds;
  }
  return seconds > 0 ? core_seconds / seconds : 0;
}

double Figure::total(double BenchRepetition::*number) const {
  double sum = 0;
  for (const BenchRepetition& repetition : repetitions) sum += repetition.*number;
  return sum;
}

double Figure::total(double BenchWork::*number) const {
  double sum = 0;
  for (const BenchRepetition& repetition : repetitions) sum += repetition.work.*number;
  return sum;
}

void find_bounds(std::vector<Figure>& figures, int machine_cores) {
  for (Figure& figure : figures)
    figure.bound = bound_of(evidence_of(figure, figures, machine_cores));
}

}  // namespace semigeo::jobs
