#include <Eigen/Geometry>
#include <filesystem>
#include <string>

#include "io/files/file_digest.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/bench/cases.hpp"
#include "jobs/bench/surfaces.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/triplets_job.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using engine::Workers;

/// Returns two boulders side by side, the second turned and smaller.
kernels::TriangleMesh two_boulders(std::int64_t vertices) {
  kernels::TriangleMesh scene = boulder(vertices, 0);
  const auto first = static_cast<std::int32_t>(scene.points.size());
  const kernels::TriangleMesh other = boulder(vertices, 1);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const auto& p : other.points)
    scene.points.push_back(0.8 * turn * p + Eigen::Vector3d(3, 0, 0));
  for (const auto& [a, b, c] : other.triangles)
    scene.triangles.push_back({first + a, first + b, first + c});
  return scene;
}

/// Makes models, libraries and a scene when they are first asked for.
class RecognitionBench {
 public:
  explicit RecognitionBench(BenchInputsPointer inputs)
      : inputs_(std::move(inputs)), folder_(inputs_->folder() / "recognition") {}

  /// Makes the datasets of the models and their runs.
  void make_models(Workers& workers) {
    if (!runs_.empty()) return;
    fs::create_directories(folder_);
    for (int i = 0; i < inputs_->sizes().models; ++i) {
      const fs::path scan = folder_ / (name_of_model(i) + ".ply");
      write_mesh(scan, boulder(inputs_->sizes().model_vertices, i));
      datasets_.push_back(folder_ / (name_of_model(i) + ".vtkhdf"));
      write_dataset(scan, datasets_.back(), 0, context(workers));
      runs_.push_back(folder_ / (name_of_model(i) + ".run"));
      make_run(i, workers);
    }
  }
  /// Makes the runs of a library with many models: the same models under other names.
  void make_many_runs(Workers& workers) {
    if (!many_runs_.empty()) return;
    make_models(workers);
    for (int i = 0; i < inputs_->sizes().library_models; ++i) {
      const io::TripletRun run(runs_[i % runs_.size()]);
      kernels::RecognitionModel model = run.read_model();
      model.name = name_of_model(i);
      many_runs_.push_back(folder_ / ("many-" + model.name + ".run"));
      io::write_triplet_run(many_runs_.back(), "bench", model, run.read_triplets());
    }
  }
  /// Makes the library of the models, and a scene with two of them.
  void make_scene(Workers& workers) {
    if (!scene_.scene.empty()) return;
    make_models(workers);
    scene_.scene = folder_ / "scene.ply";
    scene_.name = scene_.input_name = "scene.ply";
    scene_.library = folder_ / "library.h5";
    scene_.output = folder_ / "scene.json";
    scene_.key = "bench";
    write_mesh(scene_.scene, two_boulders(inputs_->sizes().model_vertices));
    scene_.input_xxh3 = io::xxh3_of_file(scene_.scene);
    scene_.library_digest = make_library(runs_, scene_.library, workers).digest;
  }

  BenchWork find_triplets(Workers& workers) {
    return {.amount = make_run(0, workers), .memory_bytes = evolved_bytes(1)};
  }
  BenchWork build(Workers& workers) {
    const LibraryJobResult result = make_library(many_runs_, folder_ / "many.h5", workers);
    const auto postings = static_cast<double>(result.postings);
    // They are read, sorted, written as partitions, read, and written again.
    return {.amount = postings, .memory_bytes = 5 * sizeof(kernels::Posting) * postings};
  }
  BenchWork recognise(Workers& workers) {
    run_recognise_job(scene_, {}, context(workers));
    return {.amount = 1, .memory_bytes = evolved_bytes(2)};
  }

 private:
  /// Returns the bytes that memory must move at least to find the features of so many models.
  double evolved_bytes(double models) const {
    constexpr double kVertexBytes = 1000;  // for each level, as of a job
    return models * kVertexBytes * RecognitionParameters{}.levels *
           static_cast<double>(inputs_->sizes().model_vertices);
  }
  static std::string name_of_model(int i) {
    const std::string digits = std::to_string(i);
    return "model-" + std::string(6 - digits.size(), '0') + digits;
  }
  engine::RunContext context(Workers& workers) { return {workers, inputs_->observer(), {}}; }

  /// Makes the run of a model. Returns the number of its triplets.
  double make_run(int i, Workers& workers) {
    return static_cast<double>(
        run_triplets_job({.dataset = datasets_[i],
                          .name = name_of_model(i),
                          .output = runs_[i],
                          .key_of = [](const std::string&) { return std::string("bench"); }},
                         {}, context(workers))
            .triplets);
  }
  LibraryJobResult make_library(const std::vector<fs::path>& runs, const fs::path& library,
                                Workers& workers) {
    LibraryJob job = {.runs = runs,
                      .partitions = {},
                      .parameters = json_of(RecognitionParameters{}),
                      .output = library,
                      .key = "bench"};
    for (const io::ShapeRange& shapes : partition_shapes(static_cast<std::int64_t>(runs.size()))) {
      job.partitions.push_back(folder_ / ("part" + std::to_string(shapes.first)));
      run_partition_job(
          {.runs = runs, .shapes = shapes, .output = job.partitions.back(), .key = "bench"},
          context(workers));
    }
    return run_library_job(job, context(workers));
  }

  BenchInputsPointer inputs_;
  fs::path folder_;
  std::vector<fs::path> datasets_, runs_, many_runs_;
  RecogniseJob scene_;
};

}  // namespace

void add_recognition_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                           const std::vector<int>& threads) {
  const auto shared = std::make_shared<RecognitionBench>(inputs);
  for (const int count : threads)
    cases.push_back({.name = "library/triplets",
                     .unit = "triplets/s",
                     .threads = count,
                     .run = [shared](Workers& w) { return shared->find_triplets(w); },
                     .prepare = [shared](Workers& w) { shared->make_models(w); }});
  for (const int count : threads)
    cases.push_back({.name = "library/build",
                     .unit = "triplets/s",
                     .threads = count,
                     .run = [shared](Workers& w) { return shared->build(w); },
                     .prepare = [shared](Workers& w) { shared->make_many_runs(w); }});
  for (const int count : threads)
    cases.push_back({.name = "recognise/scene",
                     .unit = "scenes/s",
                     .threads = count,
                     .run = [shared](Workers& w) { return shared->recognise(w); },
                     .prepare = [shared](Workers& w) { shared->make_scene(w); }});
}

}  // namespace semigeo::jobs
