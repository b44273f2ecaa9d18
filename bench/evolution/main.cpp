// What becomes of a surface from level to level, and what each level costs.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/evolution/scan_report.hpp"
#include "bench/support/examples_first.hpp"
#include "engine/stopwatch.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"
#include "tests/support/analytic_surfaces.hpp"

namespace semigeo::evolution {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

struct Options {
  std::vector<fs::path> scans;
  std::vector<std::string> shapes;
  int vertices = 40000;
  double noise = 0;
  int levels = 8;
  std::string surface = "curved";
  std::string coordinates = "semigeodesic";
  std::string schedule = "uniform";
  std::string rescale = "size";
  bool no_remesh = false;
  jobs::PreparationOptions preparation;
  fs::path csv, json, plot;
  int threads = 0;
};

/// Adds up the time of each stretch until it is taken. Stretches come from the thread that drives
/// the computation.
class Clock : public engine::Observer {
 public:
  void timed(std::string_view stretch, double seconds, double cpu_seconds) override {
    seconds_[std::string(stretch)] += {seconds, cpu_seconds};
  }
  Seconds take(const std::string& stretch) { return std::exchange(seconds_[stretch], Seconds()); }
  /// Runs `body` as the stretch "body".
  template <typename Body>
  auto time(const Body& body) {
    const engine::Stopwatch stopwatch(*this, "body");
    return body();
  }
  Seconds body() { return take("body"); }

 private:
  std::map<std::string, Seconds> seconds_;
};

jobs::EvolutionOptions evolution_options(const Options& options) {
  return {.curved = options.surface == "curved",
          .coordinates = options.coordinates == "polar" ? kernels::Coordinates::kPolar
                                                        : kernels::Coordinates::kSemigeodesic,
          .schedule =
              options.schedule == "octaves" ? jobs::Schedule::kOctaves : jobs::Schedule::kUniform,
          .rescale = options.rescale == "size"    ? jobs::Rescale::kSize
                     : options.rescale == "edges" ? jobs::Rescale::kEdges
                                                  : jobs::Rescale::kNone,
          .remesh = !options.no_remesh};
}

/// Holds the name and the mesh of one scan, which was read or made.
struct Source {
  std::string name;
  std::function<kernels::TriangleMesh()> mesh;
};

std::vector<Source> sources(const Options& options) {
  std::vector<Source> result;
  for (const fs::path& path : options.scans)
    result.push_back({path.filename().string(), [path] { return io::read_scan(path).mesh; }});
  for (const std::string& name : options.shapes)
    for (const shapes::AnalyticSurface& surface : shapes::analytic_surfaces())
      if (surface.name == name)
        result.push_back({name, [&surface, &options] {
                            shapes::AnalyticMesh made = shapes::tessellate(
                                surface, shapes::Tessellation::kEven, options.vertices);
                            if (options.noise > 0)
                              shapes::add_normal_noise(
                                  made, options.noise * shapes::mean_edge_length(made.mesh), 1);
                            return std::move(made.mesh);
                          }});
  return result;
}

/// Evolves a scan as a surface job does, but writes nothing.
ScanReport measure(const Source& source, const Options& options, engine::Workers& workers) {
  Clock clock;
  const engine::RunContext context{workers, clock, {}};
  ScanReport report;
  report.name = source.name;
  kernels::TriangleMesh mesh = clock.time(source.mesh);
  report.reading = clock.body();
  kernels::BuiltSurface built = clock.time([&] { return kernels::build_surface(std::move(mesh)); });
  report.repair = clock.body();
  if (built.surface.face_count() == 0) throw std::runtime_error("no face is left after repair");
  report.scanned_vertices = built.surface.vertex_count();
  jobs::PreparedSurface prepared =
      prepare_surface(std::move(built.surface), options.preparation, context);
  report.filling = clock.take("filling");
  report.decimation = clock.take("decimation");

  LevelMeter meter(prepared.surface);
  std::vector<std::int32_t> order;
  kernels::Surface surface = clock.time([&] {
    order = kernels::locality_order(prepared.surface);
    return kernels::reordered(prepared.surface, order);
  });
  report.ordering = clock.body();
  prepared = {};
  const auto evolving = clock.time([&] {
    return std::make_unique<jobs::EvolvingSurface>(
        std::move(surface), evolution_options(options), context,
        jobs::Origins{.vertex = std::move(order), .vertex_filled = {}, .face_filled = {}});
  });
  report.normals = clock.body();
  Seconds remeshing;
  for (int k = 0; k <= options.levels; ++k) {
    const jobs::LevelFields fields =
        clock.time([&] { return evolving->advance(k < options.levels); });
    report.levels.push_back(meter.measure(fields, context));
    LevelReport& level = report.levels.back();
    level.remeshing = std::exchange(remeshing, clock.take("remeshing"));
    level.smoothing = clock.body() - remeshing;
  }
  return report;
}

void write_reports(const Options& options, const std::vector<ScanReport>& scans) {
  if (!options.csv.empty()) io::write_file_atomically(options.csv, csv(scans));
  if (!options.json.empty()) io::write_file_atomically(options.json, json(scans));
  if (!options.plot.empty()) io::write_file_atomically(options.plot, plots(scans));
}

int run(const Options& options) {
  engine::Workers workers(options.threads);
  std::vector<ScanReport> reports;
  int exit_code = kDone;
  for (const Source& source : sources(options)) {
    try {
      reports.push_back(measure(source, options, workers));
      print(reports.back());
      std::fflush(stdout);
    } catch (const io::Error& e) {
      std::fprintf(stderr, "evolution: %s\n", e.what());
      exit_code = kFailed;
    } catch (const std::runtime_error& e) {
      std::fprintf(stderr, "evolution: %s: %s\n", source.name.c_str(), e.what());
      exit_code = kFailed;
    }
  }
  write_reports(options, reports);
  return exit_code;
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const shapes::AnalyticSurface& shape : shapes::analytic_surfaces())
    names.push_back(shape.name);
  return names;
}

void add_sources(CLI::App& app, Options& options) {
  app.add_option("scans", options.scans, "PLY, OBJ, OFF, STL, each also .gz")
      ->check(CLI::ExistingFile);
  app.add_option("--shape", options.shapes, "Shapes to make instead, or as well")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(shape_names()));
  app.add_option("--vertices", options.vertices, "Of each shape, about")
      ->check(CLI::Range(100, 100'000'000));
  app.add_option("--noise", options.noise,
                 "Sigma of a shape's vertices along their normals, in mean edge lengths")
      ->check(CLI::Range(0.0, 10.0));
}

/// Adds the options of `semigeo run` that change levels.
void add_evolution(CLI::App& app, Options& options) {
  app.add_option("--fill-holes", options.preparation.fill_holes, "Of at most so many edges")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--decimate", options.preparation.decimate, "Tolerance in mean edge lengths")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--levels", options.levels, "Smoothings")->check(CLI::Range(0, 999));
  app.add_option("--surface", options.surface)->check(CLI::IsMember({"curved", "flat"}));
  app.add_option("--coordinates", options.coordinates)
      ->check(CLI::IsMember({"semigeodesic", "polar"}));
  app.add_option("--schedule", options.schedule)->check(CLI::IsMember({"uniform", "octaves"}));
  app.add_option("--rescale", options.rescale)->check(CLI::IsMember({"size", "edges", "none"}));
  app.add_flag("--no-remesh", options.no_remesh, "Keep the connectivity of level 0");
  app.add_option("--threads", options.threads, "0: one per core")->check(CLI::Range(0, 4096));
}

}  // namespace
}  // namespace semigeo::evolution

int main(int argc, char** argv) {
  using namespace semigeo::evolution;
  CLI::App app{"What becomes of surfaces from level to level, and what each level costs.",
               "evolution"};
  app.formatter(std::make_shared<semigeo::bench::ExamplesFirst>());
  app.footer(
      "Examples:\n"
      "  evolution scan.ply --levels 20 --plot levels.svg     area, volume, parts\n"
      "  evolution a.ply b.obj --rescale edges --csv levels.csv\n"
      "  evolution --shape torus --vertices 1000000 --noise 0.3 --levels 4\n"
      "\n"
      "Distances moved are means over the descendants of level 0, in its mean edge lengths.\n"
      "remesh s: on the way to the level; smooth s: its curvature, and the smoothing to the next.\n"
      "Seconds are those of all threads together; --csv and --json have those on the wall as "
      "well.\n");
  app.option_defaults()->always_capture_default();
  Options options;
  add_sources(app, options);
  add_evolution(app, options);
  app.add_option("--csv", options.csv, "A row a level");
  app.add_option("--json", options.json, "The same, and the seconds before level 0");
  app.add_option("--plot", options.plot, "An SVG: area, volume and parts over the levels");
  try {
    app.parse(argc, argv);
    if (options.scans.empty() && options.shapes.empty())
      throw CLI::RequiredError("a scan or --shape");
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  try {
    return run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "evolution: %s\n", e.what());
    return kFailed;
  }
}
