// A whole small job: a scan is read, repaired, prepared and evolved, its dataset written and read
// again, and the triplets for a library are made of it.
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/dataset/dataset.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/number_text.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/surface_job.hpp"
#include "jobs/stages/triplets_job.hpp"
#include "tests/fuzz/made_mesh.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

jobs::SurfaceParameters made_parameters(Numbers& numbers) {
  using kernels::Coordinates;
  jobs::SurfaceParameters parameters;
  parameters.levels = static_cast<int>(numbers.below(4));
  const unsigned bits = numbers.word();
  const auto bit = [&](unsigned i) { return (bits >> i & 1) != 0; };
  jobs::EvolutionOptions& evolution = parameters.evolution;
  evolution.curved = !bit(0);
  evolution.coordinates = bit(1) ? Coordinates::kPolar : Coordinates::kSemigeodesic;
  evolution.schedule = bit(2) ? jobs::Schedule::kOctaves : jobs::Schedule::kUniform;
  evolution.rescale = bit(3)   ? jobs::Rescale::kEdges
                      : bit(4) ? jobs::Rescale::kNone
                               : jobs::Rescale::kSize;
  evolution.remesh = !bit(5);
  evolution.principal = bit(6);
  constexpr double kSteps[] = {1, 0.05, 0.5, 20};
  evolution.step_factor = kSteps[bits >> 7 & 3];
  if (bit(9)) parameters.preparation.fill_holes = 1000;
  if (bit(10)) parameters.preparation.decimate = 0.1;
  if (bit(11)) parameters.preparation.target_vertices = 20;
  if (bit(12)) parameters.features.radius = 0;
  if (bit(13)) parameters.precision = jobs::Precision::kScan;
  if (bit(14)) parameters.compression = io::Compression::kNone;
  if (bit(15)) parameters.weld = "exact";
  return parameters;
}

/// Returns the text of an OBJ file.
std::string text_of(const kernels::TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& p : mesh.points)
    text += "v " + io::number_text(p.x()) + ' ' + io::number_text(p.y()) + ' ' +
            io::number_text(p.z()) + '\n';
  for (const auto& t : mesh.triangles)
    text += "f " + std::to_string(t[0] + 1) + ' ' + std::to_string(t[1] + 1) + ' ' +
            std::to_string(t[2] + 1) + '\n';
  return text;
}

void check_dataset(const jobs::SurfaceJobResult& result, const std::filesystem::path& path) {
  const io::Dataset dataset(path);
  dataset.verify();
  check(dataset.level_count() == result.levels, "a level is missing");
  for (int level = 0; level < dataset.level_count(); ++level) {
    const io::LevelInfo info = dataset.level(level);
    for (const float value : dataset.read_floats(level, "points"))
      check(std::isfinite(value), "a point of a level is not finite");
    for (const std::int64_t corner : dataset.read_integers(level, "triangles"))
      check(corner >= 0 && corner < info.vertices, "a corner of a level does not exist");
  }
  check(!io::sidecar_text(path).empty(), "a dataset has no sidecar");
}

void do_job(const jobs::SurfaceJob& job, const jobs::SurfaceParameters& parameters) {
  static engine::Workers workers(1);
  static engine::Observer observer;
  const engine::RunContext context = {workers, observer, {}};
  const jobs::SurfaceJobResult result = jobs::run_surface_job(job, parameters, context);
  check_dataset(result, job.output);
  const std::filesystem::path run = folder() / "scan.run";
  jobs::run_triplets_job({.dataset = job.output,
                          .name = "scan",
                          .output = run,
                          .key_of = [](const std::string&) { return std::string("key"); }},
                         {}, context);
  check(io::triplet_run_key(run) == "key", "a run has another key");
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  const jobs::SurfaceParameters parameters = made_parameters(numbers);
  const std::filesystem::path scan = write("scan.obj", text_of(made_mesh(numbers)));
  try {
    do_job({.input = scan,
            .input_name = "scan.obj",
            .name = "scan",
            .output = folder() / "scan.vtkhdf",
            .input_xxh3 = io::xxh3_of_file(scan),
            .key = "key"},
           parameters);
  } catch (const io::Error& error) {
    check(error.file().native().starts_with(folder().native()), "an error names another file");
    check(error.file() == scan || error.file() == folder() / "scan.vtkhdf", "a job fails late");
  }
}

}  // namespace semigeo::fuzz
