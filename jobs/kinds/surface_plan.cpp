#include "jobs/kinds/surface_plan.hpp"

#include <algorithm>
#include <utility>

#include "io/dataset/dataset.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/small_file.hpp"
#include "io/files/utf8.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/archive/verification.hpp"
#include "jobs/kinds/surface.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Kind = Reason::Kind;

/// Returns what differs between what a dataset was made of and what the job would make it of.
std::vector<Reason> differences(const io::DatasetOrigin& origin, const Job& job) {
  std::vector<Reason> reasons;
  const std::string& input_xxh3 = surface_data(job).input_xxh3;
  if (origin.input_xxh3 != input_xxh3)
    reasons.push_back({.kind = Kind::kScan, .before = origin.input_xxh3, .now = input_xxh3});
  const auto parameters_before = io::parse_json(origin.parameters_json, {});
  std::ranges::move(parameter_differences(parameters_before, json_of(surface_data(job).parameters)),
                    std::back_inserter(reasons));
  // If this program gives another key to the old inputs, it makes other bytes of them.
  if (origin.job_key != surface_key(job.name, origin.input_xxh3, origin.parameters_json))
    reasons.push_back({.kind = Kind::kProgram, .before = origin.creator_version});
  return reasons;
}

std::vector<Reason> reasons_of_dataset(const Job& job) {
  try {
    return differences(io::read_origin(job.output), job);
  } catch (const io::ReadError&) {
    throw;
  } catch (const io::Error& error) {
    return {{.kind = Kind::kUnusableDataset, .now = error.problem()}};
  }
}

/// Compares the dataset in the archive, if there is one, with what the job would make. If the
/// system refuses to read it, the job fails: hours of work are not done again because of that.
void judge_dataset(PlannedJob& planned, DigestCache& cache) try {
  const Job& job = planned.job;
  if (!io::is_there(job.output)) {
    planned.reasons = {{.kind = Kind::kNoDataset}};
  } else if (const auto keys = cache.dataset_keys(job.name); !keys || keys->job_key != job.key) {
    planned.reasons = reasons_of_dataset(job);
  } else if (!io::is_there(io::sidecar_of(job.output))) {
    planned.reasons = {{.kind = Kind::kNoSidecar}};
    surface_data(planned.job).sidecar_only = true;
  } else {
    planned.up_to_date = true;
  }
} catch (const io::ReadError& error) {
  fail_to_read(planned, error.what());
}

/// Returns whether the sidecar of a whole dataset says what it must.
bool sidecar_is_right(const fs::path& dataset) {
  return io::has_text(io::sidecar_of(dataset), io::sidecar_text(dataset));
}

}  // namespace

std::vector<PlannedJob> plan_surfaces(const fs::path& archive, const std::vector<FoundScan>& scans,
                                      const SurfaceParameters& parameters, DigestCache& cache,
                                      int threads) {
  std::vector<PlannedJob> plan(scans.size());
  std::vector<Unnamed> unnamed;
  std::vector<ScanDigest> digests = cache.scan_digests(scans, threads);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    PlannedJob& planned = plan[i];
    planned.job.kind = &surface_kind();
    planned.job.input = scans[i].input;
    planned.job.data = SurfaceJobData{.input_name = io::as_utf8(scans[i].relative),
                                      .input_xxh3 = digests[i].xxh3,
                                      .parameters = parameters};
    planned.scan = scans[i].file;
    planned.member_bytes = scans[i].bytes + digests[i].companion_bytes;
    planned.error = std::move(digests[i].error);
    planned.inputs_are_there = true;
    unnamed.push_back({scans[i].name, scans[i].file, std::move(digests[i].xxh3)});
  }
  const auto names = choose_names(unnamed, Sources::read(archive),
                                  [&](const std::string& name, const std::string& xxh3) {
                                    const auto keys = cache.dataset_keys(name);
                                    return keys && keys->input_xxh3 == xxh3;
                                  });
  const std::string parameters_json = to_json(parameters);
  for (std::size_t i = 0; i < plan.size(); ++i) {
    Job& job = plan[i].job;
    job.name = names[i];
    job.output = dataset_path(archive, job.name);
    job.key = surface_key(job.name, surface_data(job).input_xxh3, parameters_json);
    if (is_readable(plan[i])) judge_dataset(plan[i], cache);
  }
  return plan;
}

void verify_surfaces(std::vector<PlannedJob>& plan, int at_once) {
  std::vector<PlannedJob*> jobs;
  std::vector<fs::path> datasets;
  for (PlannedJob& planned : plan) {
    if (planned.job.kind != &surface_kind()) continue;
    if (!planned.up_to_date && !surface_data(planned.job).sidecar_only) continue;
    jobs.push_back(&planned);
    datasets.push_back(planned.job.output);
  }
  const std::vector<Verified> problems = verify_datasets(datasets, at_once);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    PlannedJob& planned = *jobs[i];
    if (!problems[i].was_read) {
      fail_to_read(planned, problems[i].problem);
    } else if (!problems[i].problem.empty()) {
      planned.reasons = {{.kind = Kind::kDamagedArrays, .now = problems[i].problem}};
      surface_data(planned.job).sidecar_only = false;
    } else if (planned.up_to_date && !sidecar_is_right(datasets[i])) {
      planned.reasons = {{.kind = Kind::kDamagedSidecar}};
      surface_data(planned.job).sidecar_only = true;
    } else {
      continue;
    }
    planned.up_to_date = false;
  }
}

void record_sources(const fs::path& archive, const std::vector<PlannedJob>& plan) {
  Sources sources = Sources::read(archive);
  for (const PlannedJob& planned : plan)
    if (planned.job.kind == &surface_kind() && is_readable(planned))
      sources.claim(planned.job.name, planned.scan);
  sources.write(archive);
}

}  // namespace semigeo::jobs
