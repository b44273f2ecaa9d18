#include "jobs/bench/bound.hpp"

namespace semigeo::jobs {
namespace {

constexpr double kBusy = 0.8;          // share of the cores that counts as all of them
constexpr double kMuchMemory = 0.5;    // share of what memory can move that bounds
constexpr double kLittleMemory = 0.2;  // share that does not
constexpr double kMostlyLocked = 0.5;  // share of the time that bounds
constexpr double kMostlyAlone = 0.5;   // share of the time with one core busy that bounds

Bound of_one_thread(const BoundEvidence& evidence) {
  if (evidence.busy < kBusy) return evidence.used_disk ? Bound::kDisk : Bound::kUnclear;
  if (evidence.memory >= kMuchMemory) return Bound::kMemory;
  const bool little = evidence.memory > 0 && evidence.memory < kLittleMemory;
  return little ? Bound::kArithmetic : Bound::kUnclear;
}

Bound of_many_threads(const BoundEvidence& evidence) {
  const bool all_busy = evidence.busy >= kBusy * evidence.threads;
  // Files that are written side by side may wait for the disk at the same time.
  if (evidence.alone_on_disk && !all_busy) return Bound::kDisk;
  if (evidence.speedup >= kBusy * evidence.threads) return Bound::kCores;
  if (evidence.memory >= kMuchMemory) return Bound::kMemory;
  if (all_busy) return Bound::kUnclear;
  if (evidence.locked >= kMostlyLocked) return Bound::kLock;
  if (evidence.busy < kBusy) return evidence.used_disk ? Bound::kDisk : Bound::kUnclear;
  // The share of the time in which one core was busy, if all were for the rest of it.
  const double alone = (evidence.threads - evidence.busy) / (evidence.threads - 1);
  return alone >= kMostlyAlone ? Bound::kOneCore : Bound::kUnclear;
}

}  // namespace

std::string_view name_of(Bound bound) {
  switch (bound) {
    case Bound::kArithmetic:
      return "arithmetic";
    case Bound::kMemory:
      return "memory";
    case Bound::kDisk:
      return "disk";
    case Bound::kLock:
      return "lock";
    case Bound::kCores:
      return "cores";
    case Bound::kOneCore:
      return "one core";
    case Bound::kUnclear:
      break;
  }
  return "unclear";
}

Bound bound_of(const BoundEvidence& evidence) {
  // While other processes have the cores, a thread that does not run may be waiting for a core.
  const bool waited = evidence.busy < kBusy * evidence.threads;
  if (waited && evidence.disturbed) return Bound::kUnclear;
  return evidence.threads == 1 ? of_one_thread(evidence) : of_many_threads(evidence);
}

}  // namespace semigeo::jobs
