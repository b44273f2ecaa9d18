// Which share of a mesh's features is found again when it is scanned anew, rotated, noisy, or cut.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/repeatability/mesh_changes.hpp"
#include "bench/repeatability/repeats.hpp"
#include "bench/repeatability/report.hpp"
#include "bench/repeatability/scale_levels.hpp"
#include "bench/support/examples_first.hpp"
#include "engine/stopwatch.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::repeatability {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

/// Features nearer to a cut than this number of scales of their level do not count. Half a patch is
/// four steps.
constexpr double kReach = 4;
/// A changed mesh gets at most this number of times the levels of the original. A finer mesh needs
/// more levels to reach the same scale.
constexpr int kMaxLevelFactor = 8;

struct Options {
  std::vector<fs::path> scans;
  bool closed = false;
  int levels = 4;
  std::string schedule = "octaves";
  std::string coordinates = "semigeodesic";
  std::vector<std::string> cases;
  double tolerance = 1;
  FeatureSearch search;
  ChangeOptions change;
  fs::path csv;
  int threads = 0;
};

bool is_closed(const kernels::Surface& surface) {
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    if (surface.on_boundary(v)) return false;
  return true;
}

/// Holds what all cases of one mesh share.
struct Original {
  std::string name;
  kernels::Surface surface;
  double mean_edge_length = 0;
  std::vector<ScaleLevel> levels;
};

/// Returns the rows of one changed mesh.
void compare(const Original& original, const Case& change, const ChangedMesh& changed,
             std::span<const ScaleLevel> levels, const Options& options, std::vector<Row>& rows) {
  for (std::size_t k = 0; k < original.levels.size(); ++k) {
    const ScaleLevel& level = original.levels[k];
    const std::size_t other = nearest_level(levels, level.scale);
    const RepeatOptions limits{.tolerance = options.tolerance * original.mean_edge_length,
                               .area = changed.area,
                               .scale = level.scale,
                               .counts = [&](const Eigen::Vector3d& p) {
                                 return !changed.cut ||
                                        changed.cut->signedDistance(p) >= kReach * level.scale;
                               }};
    for (int i = 0; i < kernels::kFeatureKinds; ++i) {
      const auto kind = static_cast<kernels::FeatureKind>(i);
      for (std::size_t r = 0; r < (has_radius(kind) ? options.search.radii.size() : 1); ++r)
        rows.push_back(
            {.mesh = original.name,
             .change = change.name,
             .kind = kind,
             .level = static_cast<int>(k),
             .radius = has_radius(kind) ? options.search.radii[r] : 0,
             .mean_edge_length = original.mean_edge_length,
             .scale = level.scale,
             .changed_level = static_cast<int>(other),
             .changed_scale = levels[other].scale,
             .repeats = repeats(level.of_radius[r][i], levels[other].of_radius[r][i], limits)});
    }
  }
}

/// Examines one mesh. Returns whether it was used.
bool measure(const fs::path& path, const Options& options, const engine::RunContext& context,
             std::vector<Row>& rows) {
  kernels::BuiltSurface built = kernels::build_surface(io::read_scan(path).mesh);
  if (built.surface.face_count() == 0) throw std::runtime_error("no face is left after repair");
  if (options.closed && !is_closed(built.surface)) return false;
  // From here on all points are relative to the origin of the surface.
  built.origin.setZero();
  Original original{.name = path.filename().string(),
                    .surface = built.surface,
                    .mean_edge_length = kernels::mean_edge_length(built.surface),
                    .levels = {}};
  const int levels = options.levels + 1;
  original.levels = scale_levels(built, {}, options.search, levels, 0, levels, context);
  MeshChanger changer(original.surface, options.change);
  for (const Case& change : all_cases()) {
    if (std::ranges::count(options.cases, change.name) == 0) continue;
    ChangedMesh changed = changer.changed(change);
    const kernels::BuiltSurface surface = kernels::build_surface(std::move(changed.mesh));
    if (surface.surface.face_count() == 0) continue;
    const auto found =
        scale_levels(surface, changed.similarity, options.search, 1, original.levels.back().scale,
                     kMaxLevelFactor * levels, context);
    compare(original, change, changed, found, options, rows);
  }
  return true;
}

int run(Options options) {
  options.search.evolution.schedule =
      options.schedule == "octaves" ? jobs::Schedule::kOctaves : jobs::Schedule::kUniform;
  options.search.evolution.coordinates = options.coordinates == "polar"
                                             ? kernels::Coordinates::kPolar
                                             : kernels::Coordinates::kSemigeodesic;
  engine::Workers workers(options.threads);
  engine::Observer observer;
  const engine::RunContext context{workers, observer, {}};
  std::vector<Row> rows;
  int exit_code = kDone;
  for (const fs::path& path : options.scans) {
    try {
      if (!measure(path, options, context, rows))
        std::fprintf(stderr, "repeatability: %s: skipped: it has a boundary\n", path.c_str());
    } catch (const io::Error& e) {
      std::fprintf(stderr, "repeatability: %s\n", e.what());
      exit_code = kFailed;
    } catch (const std::runtime_error& e) {
      std::fprintf(stderr, "repeatability: %s: %s\n", path.c_str(), e.what());
      exit_code = kFailed;
    }
  }
  if (!options.csv.empty()) io::write_file_atomically(options.csv, csv(rows));
  if (!rows.empty()) print(rows);
  return exit_code;
}

void add_options(CLI::App& app, Options& options) {
  std::vector<std::string> names;
  for (const Case& change : all_cases()) names.push_back(change.name);
  options.cases = names;
  app.add_option("scans", options.scans, "PLY, OBJ, OFF, STL, each also .gz")
      ->required()
      ->check(CLI::ExistingFile);
  app.add_flag("--closed", options.closed, "Skip meshes with a boundary");
  app.add_option("--cases", options.cases, "What is done to the meshes")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names));
  app.add_option("--schedule", options.schedule, "How the scale grows from level to level")
      ->check(CLI::IsMember({"uniform", "octaves"}));
  app.add_option("--coordinates", options.coordinates)
      ->check(CLI::IsMember({"semigeodesic", "polar"}));
  app.add_option("--levels", options.levels, "Smoothings of the original; the others follow")
      ->check(CLI::Range(0, 999));
  app.add_option("--radius", options.search.radii,
                 "Scales within which a maximum is one; 0: its neighbours")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.0, 100.0));
  app.add_flag("--strong", options.search.strong,
               "Maxima only where |K| scale^2 >= 0.01, |H| scale >= 0.1");
  app.add_option("--tolerance", options.tolerance, "In mean edge lengths of the original")
      ->check(CLI::Range(1e-3, 1e3));
  app.add_option("--noise", options.change.noise,
                 "Sigma in every coordinate, in mean edge lengths of the mesh it is added to")
      ->check(CLI::Range(0.0, 10.0));
  app.add_option("--vertices-left", options.change.vertices_left, "Share after decimation")
      ->check(CLI::Range(0.01, 1.0));
  app.add_option("--seed", options.change.seed, "Of cuts, noise, rotations, scales and shifts");
  app.add_option("--csv", options.csv, "A row for each mesh, case, kind, level and radius");
  app.add_option("--threads", options.threads, "0: one per core")->check(CLI::Range(0, 4096));
}

}  // namespace
}  // namespace semigeo::repeatability

int main(int argc, char** argv) {
  using namespace semigeo::repeatability;
  CLI::App app{
      "Which share of the features comes back when a mesh is digitised anew, moved, noisy "
      "or cut.",
      "repeatability"};
  app.formatter(std::make_shared<semigeo::bench::ExamplesFirst>());
  app.footer(
      "Examples:\n"
      "  repeatability a.ply b.obj --closed --csv repeats.csv\n"
      "  repeatability a.ply --cases decimated,noise --radius 1.5 --strong\n"
      "\n"
      "A feature comes back if the changed mesh, on the level of the nearest scale, has one of "
      "the\n"
      "same kind and sign within one mean edge length of it, both taken back to level 0 and to\n"
      "where the original is. Features on what is cut away, or within four scales of the cut, do\n"
      "not count. By chance: if as many random points took the place of the features found.\n");
  app.option_defaults()->always_capture_default();
  Options options;
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  try {
    return run(std::move(options));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "repeatability: %s\n", e.what());
    return kFailed;
  }
}
