#include "bench/recognition/model_library.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "io/library/triplet_run.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::recognition {

ModelLibraries::ModelLibraries(ModelSpan models, const jobs::RecognitionParameters& parameters,
                               std::filesystem::path folder, const engine::RunContext& context)
    : folder_(std::move(folder)), context_(context) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    kernels::RecognitionModel model =
        jobs::recognition_model(models[i]->built, parameters, context);
    model.name = models[i]->name;
    // There is no dataset, so this is no real digest.
    char digest[33];
    std::snprintf(digest, sizeof digest, "%032zx", i);
    model.digest = digest;
    const Run run{model.name, i, folder_ / (std::to_string(i) + ".run")};
    io::write_triplet_run(run.path, "bench", model, kernels::local_triplets(model.features, {}));
    runs_.push_back(run);
  }
  std::ranges::sort(runs_, {}, &Run::name);
}

std::unique_ptr<io::HashLibrary> ModelLibraries::without(
    const std::vector<std::size_t>& left_out) const {
  jobs::LibraryJob library{.runs = {},
                           .partitions = {},
                           .parameters = nlohmann::json::object(),
                           .output = folder_ / "library.h5",
                           .key = "bench"};
  for (const Run& run : runs_)
    if (std::ranges::count(left_out, run.model) == 0) library.runs.push_back(run.path);
  for (const io::ShapeRange& shapes : jobs::partition_shapes(std::ssize(library.runs))) {
    const auto path = folder_ / (std::to_string(shapes.first) + ".partition");
    jobs::run_partition_job(
        {.runs = library.runs, .shapes = shapes, .output = path, .key = "bench"}, context_);
    library.partitions.push_back(path);
  }
  jobs::run_library_job(library, context_);
  return std::make_unique<io::HashLibrary>(library.output);
}

}  // namespace semigeo::recognition
