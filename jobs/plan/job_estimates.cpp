#include "jobs/plan/job_estimates.hpp"

#include <algorithm>

#include "io/scans/scan_reader.hpp"
#include "jobs/archive/scan_size.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

// Of jobs that are not learned of: they are short beside surface jobs.
constexpr double kDatasetBytes = 150;  // a vertex: rather too many vertices
constexpr double kTripletsOfModel = 7000;
constexpr double kSecondsOfTriplet = 2e-6;
constexpr double kSecondsOfModel = 2e-4;  // to open its run
constexpr double kBaseSeconds = 0.05;
constexpr double kBaseBytes = 60e6;
constexpr double kBytesOfModel = 1000;
// Of recognition, for each byte of the library.
constexpr double kLibraryMemory = 1;
constexpr double kLibrarySeconds = 1e-9;
constexpr double kThesisMemory = 8;
constexpr double kThesisSeconds = 5e-8;
constexpr double kVerifySeconds = 0.5;  // poses
constexpr std::uint64_t kBufferBytes = std::uint64_t{512} << 20;
constexpr std::uint64_t kLeastBufferBytes = std::uint64_t{8} << 20;

/// Level 0 is smoothed as surface jobs do it, some levels only.
Estimate triplets_estimate(const std::vector<PlannedJob>& plan, const PlannedJob& planned,
                           const JobParameters& parameters, const Estimates& estimates) {
  const int levels = parameters.recognition.levels;
  if (!planned.after.empty() && !plan[planned.after.front()].up_to_date)
    return estimates.of(scan_size(plan[planned.after.front()].job.input), levels, 1);
  std::error_code error;
  const auto bytes = fs::file_size(planned.job.input, error);
  return error ? Estimate{} : estimates.of(static_cast<double>(bytes) / kDatasetBytes, levels, 1);
}

/// Its surface is smoothed like a model's; then surfaces of candidates are laid onto it.
Estimate recognise_estimate(const PlannedJob& planned, const JobParameters& parameters,
                            const Estimates& estimates) {
  const int levels = parameters.recognition.levels;
  std::error_code error;
  const auto bytes = static_cast<double>(fs::file_size(planned.job.input, error));
  Estimate estimate;
  if (!error)
    estimate = io::scan_format(planned.job.input)
                   ? estimates.of(scan_size(planned.job.input), levels, 1)
                   : estimates.of(bytes / kDatasetBytes, levels, 1);
  const auto library = static_cast<double>(fs::file_size(planned.job.library, error));
  if (error) return estimate;
  const bool thesis = parameters.search.method == RecognitionMethod::kThesis;
  estimate.peak_bytes += kBaseBytes + (thesis ? kThesisMemory : kLibraryMemory) * library;
  estimate.seconds += kVerifySeconds + (thesis ? kThesisSeconds : kLibrarySeconds) * library;
  return estimate;
}

Estimate merging_estimate(const PlannedJob& planned, int shares, std::uint64_t memory_bytes) {
  const auto models = static_cast<double>(planned.job.models.size());
  return {.peak_bytes =
              kBaseBytes + kBytesOfModel * models + static_cast<double>(buffer_bytes(memory_bytes)),
          .seconds = kBaseSeconds +
                     models * (kSecondsOfModel + kSecondsOfTriplet * kTripletsOfModel / shares)};
}

}  // namespace

std::int64_t buffer_bytes(std::uint64_t memory_bytes) {
  if (memory_bytes == 0) return kBufferBytes;
  return static_cast<std::int64_t>(std::clamp(memory_bytes / 4, kLeastBufferBytes, kBufferBytes));
}

std::vector<Estimate> estimates_of(const std::vector<PlannedJob>& plan,
                                   const JobParameters& parameters, const Estimates& estimates,
                                   std::uint64_t memory_bytes) {
  const auto partitions = static_cast<int>(std::ranges::count_if(
      plan, [](const PlannedJob& one) { return one.job.kind == JobKind::kPartition; }));
  std::vector<Estimate> result(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const PlannedJob& planned = plan[i];
    if (planned.up_to_date || !planned.error.empty()) continue;
    switch (planned.job.kind) {
      case JobKind::kSurface:
        if (!planned.sidecar_only)
          result[i] = estimates.of(scan_size(planned.job.input), parameters.surface.levels + 1, 1);
        break;
      case JobKind::kTriplets:
        result[i] = triplets_estimate(plan, planned, parameters, estimates);
        break;
      case JobKind::kPartition:
        result[i] = merging_estimate(planned, std::max(partitions, 1), memory_bytes);
        break;
      case JobKind::kLibrary:
        result[i] = merging_estimate(planned, 1, memory_bytes);
        break;
      case JobKind::kRecognise:
        result[i] = recognise_estimate(planned, parameters, estimates);
        break;
    }
  }
  return result;
}

}  // namespace semigeo::jobs
