#include "jobs/kinds/library_plan.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/archive/dataset_files.hpp"
#include "jobs/archive/verification.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/stages/partition_job.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArchiveLibrary = "library.h5";

PlannedJob triplets_of(const LibraryModel& model, const fs::path& parts,
                       const RecognitionParameters& parameters) {
  PlannedJob planned;
  planned.job = triplets_job(model.name, model.dataset, model.dataset_key, parts, parameters);
  if (model.maker) planned.after = {*model.maker};
  planned.inputs_are_there = !model.maker;
  planned.error = model.error;
  return planned;
}

Verified verify_run(const fs::path& path) {
  try {
    io::triplet_run_key(path);
    return {};
  } catch (const io::ReadError& error) {
    return {.problem = error.what(), .was_read = false};
  } catch (const io::Error& error) {
    return {.problem = error.what()};
  }
}

/// Plans a job again whose output is damaged. If its output could not be read, it fails.
void judge_again(PlannedJob& planned, const Verified& verified) {
  if (!verified.was_read) {
    fail_to_read(planned, verified.problem);
  } else if (!verified.problem.empty()) {
    plan_again(planned, verified.problem);
  }
}

}  // namespace

LibraryPlace place_of(const fs::path& library) {
  const fs::path folder = library.parent_path();
  if (library.filename() == kArchiveLibrary && io::is_folder(folder / "scans"))
    return place_of_archive(folder);
  fs::path parts = library;
  parts += ".parts";
  return {.library = library, .parts = parts, .home = parts};
}

LibraryPlace place_of_archive(const fs::path& archive) {
  return {.library = archive / kArchiveLibrary, .parts = archive / "library", .home = archive};
}

LibraryModel model_of(const fs::path& dataset) {
  LibraryModel model{.name = dataset.stem().string(), .dataset = dataset};
  try {
    model.dataset_key = io::read_origin(dataset).job_key;
  } catch (const io::Error& error) {
    model.error = error.what();
  }
  return model;
}

std::vector<LibraryModel> models_of(const fs::path& archive, const std::vector<PlannedJob>& plan,
                                    DigestCache& cache) {
  std::map<std::string, LibraryModel> models;
  for (const fs::path& path : dataset_files(archive / "scans")) {
    const std::string name = path.stem().string();
    if (const auto keys = cache.dataset_keys(name)) {
      models[name] = {.name = name, .dataset = path, .dataset_key = keys->job_key};
    } else {
      models[name] = model_of(path);
    }
  }
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const Job& job = plan[i].job;
    if (job.kind != &surface_kind()) continue;
    LibraryModel& model = models[job.name];
    // The dataset that was made while the scan could be read is still a model.
    if (!is_readable(plan[i]) && !model.dataset_key.empty()) continue;
    model = {.name = job.name,
             .dataset = job.output,
             .dataset_key = job.key,
             .maker = i,
             .error = plan[i].error};
  }
  std::vector<LibraryModel> list;
  list.reserve(models.size());
  for (auto& [name, model] : models) list.push_back(std::move(model));
  return list;
}

void plan_library(std::vector<PlannedJob>& plan, const std::vector<LibraryModel>& models,
                  const LibraryPlace& place, const RecognitionParameters& parameters) {
  std::vector<std::string> names;
  std::vector<std::string> keys;
  std::vector<std::size_t> after;
  for (const LibraryModel& model : models) {
    names.push_back(model.name);
    const bool kept = model.dataset.empty();
    if (kept) {
      keys.push_back(
          output_key(triplets_kind(), run_path(place.parts, model.name), KeyCheck::kWhole));
      continue;
    }
    // An unreadable scan is reported once, as the failure of its own job.
    if (model.maker && !model.error.empty()) continue;
    PlannedJob planned = triplets_of(model, place.parts, parameters);
    if (is_readable(planned)) keys.push_back(planned.job.key);
    after.push_back(plan.size());
    plan.push_back(std::move(planned));
  }
  const std::vector<io::ShapeRange> shapes = partition_shapes(std::ssize(keys));
  const auto partitions = static_cast<int>(shapes.size());
  PlannedJob library;
  library.job = library_job({.models = names, .partitions = partitions, .parameters = parameters},
                            place.library, place.parts, keys);
  judge_output(library);
  // If the library is up to date, its runs are not read.
  for (const std::size_t triplets : after)
    if (is_readable(plan[triplets]))
      judge_output(plan[triplets], library.up_to_date ? KeyCheck::kHead : KeyCheck::kWhole);
  for (int number = 0; number < partitions; ++number) {
    PlannedJob partition;
    partition.job = partition_job(number,
                                  {.models = names,
                                   .shapes = shapes[static_cast<std::size_t>(number)],
                                   .partitions = partitions,
                                   .library = fs::absolute(place.library),
                                   .parameters = parameters},
                                  place.parts, keys);
    partition.after = after;
    judge_output(partition);
    // Partitions are removed when the library is made.
    if (library.up_to_date) {
      partition.up_to_date = true;
      partition.reasons.clear();
    }
    library.after.push_back(plan.size());
    plan.push_back(std::move(partition));
  }
  plan.push_back(std::move(library));
}

void verify_library_plan(std::vector<PlannedJob>& plan) {
  for (PlannedJob& planned : plan) {
    if (!planned.up_to_date) continue;
    const JobKind* kind = planned.job.kind;
    if (kind == &triplets_kind()) {
      judge_again(planned, verify_run(planned.job.output));
    } else if (kind == &library_kind()) {
      judge_again(planned, verify_libraries({planned.job.output}).front());
      if (planned.up_to_date || !is_readable(planned)) continue;
      for (const std::size_t partition : planned.after) {
        plan[partition].up_to_date = false;
        judge_output(plan[partition]);
      }
    }
  }
}

}  // namespace semigeo::jobs
