// Errors of K and H on surfaces whose curvature is known.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "bench/accuracy/analytic_errors.hpp"
#include "bench/accuracy/command.hpp"
#include "io/files/atomic_file.hpp"

namespace semigeo::accuracy {
namespace {

struct AnalyticOptions {
  std::vector<std::string> shapes;
  std::vector<int> vertices = {40000, 2500};
  std::vector<double> noise = {0, 0.05, 0.15};
  std::vector<std::string> surfaces = {"curved"};
  std::vector<std::string> coordinates = {"semigeodesic"};
  std::string schedule = "uniform";
  std::filesystem::path csv;
  int levels = 16;
  int runs = 3;
  int threads = 0;
};

/// Describes one mesh and one way of sampling it.
struct Case {
  std::string shape;
  std::string tessellation;
  std::string surface;
  std::string coordinates;
  std::int64_t vertices = 0;
  bool open = false;
  std::vector<std::vector<LevelErrors>> levels;  ///< Levels for each noise.
  VertexTime time;
};

/// Returns the level with the least median error of one curvature.
int best_level(const std::vector<LevelErrors>& levels, int zone, ErrorSummary ZoneErrors::*which) {
  int best = 0;
  for (std::size_t k = 1; k < levels.size(); ++k)
    if ((levels[k][zone].*which).median < (levels[best][zone].*which).median)
      best = static_cast<int>(k);
  return best;
}

std::vector<Case> measure(const AnalyticOptions& options) {
  engine::Workers workers(options.threads);
  std::vector<Case> cases;
  for (const std::string& surface : options.surfaces)
    for (const std::string& coordinates : options.coordinates)
      for (const int vertices : options.vertices)
        for (const shapes::AnalyticSurface& shape : shapes::analytic_surfaces()) {
          if (std::ranges::count(options.shapes, shape.name) == 0) continue;
          for (const auto kind : {shapes::Tessellation::kEven, shapes::Tessellation::kUneven,
                                  shapes::Tessellation::kRagged, shapes::Tessellation::kNeedles}) {
            const jobs::EvolutionOptions evolution{
                .curved = surface == "curved",
                .coordinates = coordinates_of(coordinates),
                .schedule = options.schedule == "octaves" ? jobs::Schedule::kOctaves
                                                          : jobs::Schedule::kUniform,
                .remesh = false};  // the true curvature is known at the vertices alone
            const shapes::AnalyticMesh exact = shapes::tessellate(shape, kind, vertices);
            const double edge = shapes::mean_edge_length(exact.mesh);
            Case c{shape.name,
                   shapes::name_of(kind),
                   surface,
                   coordinates,
                   static_cast<std::int64_t>(exact.truth.size()),
                   shape.open(),
                   {},
                   vertex_time(exact, evolution, options.runs)};
            for (const double noise : options.noise) {
              shapes::AnalyticMesh rough = exact;
              shapes::add_normal_noise(rough, noise * edge, 1);
              c.levels.push_back(
                  analytic_errors(rough, noise > 0 ? options.levels : 0, evolution, workers));
            }
            cases.push_back(std::move(c));
          }
        }
  return cases;
}

std::string csv(const std::vector<Case>& cases, const std::vector<double>& noise) {
  std::string text =
      "shape,tessellation,vertices,surface,coordinates,noise,level,zone,"
      "K_median_percent,K_p95_percent,H_median_percent,H_p95_percent,vertices_used,"
      "vertices_invalid,first_level_us_per_vertex,level_us_per_vertex\n";
  for (const Case& c : cases)
    for (std::size_t n = 0; n < noise.size(); ++n)
      for (std::size_t level = 0; level < c.levels[n].size(); ++level)
        for (int zone = 0; zone < (c.open ? kZones : 1); ++zone) {
          const ZoneErrors& e = c.levels[n][level][zone];
          char row[320];
          std::snprintf(row, sizeof row,
                        "%s,%s,%lld,%s,%s,%g,%zu,%s,%.4g,%.4g,%.4g,%.4g,%lld,%lld,%.3g,%.3g\n",
                        c.shape.c_str(), c.tessellation.c_str(), static_cast<long long>(c.vertices),
                        c.surface.c_str(), c.coordinates.c_str(), noise[n], level,
                        name_of(static_cast<Zone>(zone)), e.gaussian.median, e.gaussian.p95,
                        e.mean.median, e.mean.p95, static_cast<long long>(e.used),
                        static_cast<long long>(e.invalid), 1e6 * c.time.first_level,
                        1e6 * c.time.level);
          text += row;
        }
  return text;
}

/// Returns "median / p95" with three digits each, and the level if it was chosen.
std::string cell(const std::vector<LevelErrors>& levels, int zone,
                 ErrorSummary ZoneErrors::*which) {
  const int level = best_level(levels, zone, which);
  const ErrorSummary& e = levels[level][zone].*which;
  const auto short_percent = [](double value) {
    char text[32];
    const int digits = value < 0.1 ? 3 : value < 1 ? 2 : value < 10 ? 1 : 0;
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return std::string(text);
  };
  std::string text = short_percent(e.median) + " / " + short_percent(e.p95);
  if (levels.size() > 1) text += " @" + std::to_string(level);
  return text;
}

void print_table(const std::vector<Case>& cases, const std::vector<double>& noise) {
  std::printf(
      "Errors of K and H, %%: median / 95th percentile. @n: with noise, at the best level n.\n"
      "us: per vertex on one thread, of level 0 with its normals, and of each further level.\n");
  std::string variant;
  for (const Case& c : cases) {
    const std::string heading = c.surface + " faces, " + c.coordinates + " patches";
    if (heading != variant) {
      std::printf("\n%-44s", heading.c_str());
      for (const double n : noise)
        std::printf("| %-36s", ("noise " + std::to_string(std::lround(100 * n)) + " %").c_str());
      std::printf("\n%-10s %-8s %8s %-7s  us       ", "shape", "mesh", "vertices", "zone");
      for (std::size_t n = 0; n < noise.size(); ++n) std::printf("| %-17s %-18s", "K", "H");
      std::printf("\n");
      variant = heading;
    }
    for (int zone = 0; zone < (c.open ? kZones : 1); ++zone) {
      std::printf("%-10s %-8s %8lld %-7s ", c.shape.c_str(), c.tessellation.c_str(),
                  static_cast<long long>(c.vertices),
                  c.open ? name_of(static_cast<Zone>(zone)) : "all");
      if (zone == 0) {
        std::printf("%4.1f /%4.1f", 1e6 * c.time.first_level, 1e6 * c.time.level);
      } else {
        std::printf("%10s", "");
      }
      for (const auto& levels : c.levels)
        std::printf("| %-17s %-18s", cell(levels, zone, &ZoneErrors::gaussian).c_str(),
                    cell(levels, zone, &ZoneErrors::mean).c_str());
      std::printf("\n");
    }
  }
}

int run(const AnalyticOptions& options) {
  const std::vector<Case> cases = measure(options);
  if (!options.csv.empty()) io::write_file_atomically(options.csv, csv(cases, options.noise));
  print_table(cases, options.noise);
  return kDone;
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const shapes::AnalyticSurface& shape : shapes::analytic_surfaces())
    names.push_back(shape.name);
  return names;
}

}  // namespace

void add_analytic(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<AnalyticOptions>();
  options->shapes = shape_names();
  CLI::App* command =
      app.add_subcommand("analytic", "Errors of K and H on surfaces whose curvature is known");
  command->footer(
      "Examples:\n"
      "  accuracy analytic --csv errors.csv\n"
      "  accuracy analytic --shapes torus --noise 0 --surface curved,flat --coordinates polar\n"
      "\n"
      "Errors are relative to the true K and H; where |K| < 0.1 H^2, relative to H^2, and where\n"
      "|H| < 0.1 sqrt|K|, to sqrt|K|. Zones of open surfaces: inside (8 edges from the rim or\n"
      "more), and the rings 0 (the rim itself), 1 and 2.\n");
  const auto list = [](CLI::Option* option) {
    return option->delimiter(',')->allow_extra_args(false);
  };
  list(command->add_option("--shapes", options->shapes))->check(CLI::IsMember(shape_names()));
  list(command->add_option("--vertices", options->vertices, "Sizes of the meshes, about"))
      ->check(CLI::Range(100, 10'000'000));
  list(command->add_option("--noise", options->noise,
                           "Sigmas of the vertices along their normals, in mean edge lengths"))
      ->check(CLI::Range(0.0, 10.0));
  list(command->add_option("--surface", options->surfaces, "curved, flat"))
      ->check(CLI::IsMember({"curved", "flat"}));
  list(command->add_option("--coordinates", options->coordinates, "semigeodesic, polar"))
      ->check(CLI::IsMember({"semigeodesic", "polar"}));
  command
      ->add_option("--schedule", options->schedule,
                   "uniform: parts are rescaled after each smoothing; octaves: the step grows")
      ->check(CLI::IsMember({"uniform", "octaves"}));
  command->add_option("--levels", options->levels, "Levels to choose from where there is noise")
      ->check(CLI::Range(0, 999));
  command->add_option("--runs", options->runs, "Of which the median time is reported")
      ->check(CLI::Range(1, 1000));
  command->add_option("--threads", options->threads, "For the errors; 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_option("--csv", options->csv, "Every level, zone and time, for further study");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace semigeo::accuracy
