#include "jobs/kinds/merging.hpp"

#include <algorithm>
#include <utility>

#include "jobs/kinds/triplets.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

// These rates are not learned, because merging is short in comparison with surface jobs.
constexpr double kTripletsOfModel = 7000;
constexpr double kSecondsOfTriplet = 2e-6;
constexpr double kSecondsOfModel = 2e-4;  // time to open the run of a model
constexpr double kBaseSeconds = 0.05;
constexpr double kBaseBytes = 60e6;
constexpr double kBytesOfModel = 1000;
constexpr std::uint64_t kBufferBytes = std::uint64_t{512} << 20;
constexpr std::uint64_t kLeastBufferBytes = std::uint64_t{8} << 20;

}  // namespace

std::vector<std::string> keep_models_with_runs(std::vector<std::string>& models,
                                               const fs::path& parts, const fs::path& output,
                                               OutputKeys& keys) {
  std::vector<std::string> kept;
  std::vector<std::string> kept_keys;
  for (std::string& model : models) {
    // Reading the head is enough: planning has read all bytes of the runs that existed, and the
    // others were written by this run.
    const std::string& key = keys.of(triplets_kind(), run_path(parts, model));
    if (key.empty()) continue;
    kept.push_back(std::move(model));
    kept_keys.push_back(key);
  }
  models = std::move(kept);
  if (models.empty()) throw missing_input(output, "model");
  return kept_keys;
}

std::vector<fs::path> run_paths(const fs::path& parts, const std::vector<std::string>& models) {
  std::vector<fs::path> runs;
  runs.reserve(models.size());
  for (const std::string& model : models) runs.push_back(run_path(parts, model));
  return runs;
}

std::int64_t buffer_bytes(std::uint64_t memory_bytes) {
  if (memory_bytes == 0) return kBufferBytes;
  return static_cast<std::int64_t>(std::clamp(memory_bytes / 4, kLeastBufferBytes, kBufferBytes));
}

Estimate merging_estimate(std::size_t models, int shares, std::uint64_t memory_bytes) {
  const auto count = static_cast<double>(models);
  return {.peak_bytes =
              kBaseBytes + kBytesOfModel * count + static_cast<double>(buffer_bytes(memory_bytes)),
          .seconds = kBaseSeconds +
                     count * (kSecondsOfModel + kSecondsOfTriplet * kTripletsOfModel / shares)};
}

}  // namespace semigeo::jobs
