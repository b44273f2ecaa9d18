// The experiment of thesis 6.2.1: the curvature of each vertex with each of its edges in turn as
// the first direction, at several step sizes, while the surface is smoothed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "bench/accuracy/command.hpp"
#include "bench/accuracy/direction_errors.hpp"
#include "bench/support/svg_plot.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/stages/evolving_surface.hpp"

namespace semigeo::accuracy {
namespace {

namespace fs = std::filesystem;
using bench::Plot;

struct DirectionOptions {
  std::vector<fs::path> meshes;
  fs::path output;
  std::vector<int> iterations = {0, 1, 2, 4, 8, 16, 32, 64, 100};
  std::vector<double> steps = {0.5, 0.75, 1, 1.25, 1.5, 2};
  std::string surface = "curved";
  std::string coordinates = "semigeodesic";
  double least = 0.1;
  int threads = 0;
};

/// Describes one point of the plots.
struct Measurement {
  int iteration;
  double step_factor;
  double step;  ///< In the scan's length unit.
  DirectionErrors gaussian, mean;
};

/// Calls `use(iteration, surface, fields)` at each of the iterations. The surface's points are
/// in multiples of `unit` scan units, which keeps squares of lengths within single precision.
template <typename Use>
void evolve(kernels::TriangleMesh mesh, const DirectionOptions& options, engine::Workers& workers,
            const Use& use) {
  const bool curved = options.surface == "curved";
  kernels::PreparedSurface surface(std::move(mesh), curved);
  if (surface.surface.face_count() == 0) throw std::runtime_error("no face is left after repair");
  engine::Observer observer;
  jobs::EvolvingSurface evolving(surface.surface,
                                 {.curved = curved,
                                  .coordinates = coordinates_of(options.coordinates),
                                  .rescale = jobs::Rescale::kEdges,
                                  .remesh = false},  // vertices must not be removed or inserted
                                 {workers, observer, {}});
  const std::set<int> wanted(options.iterations.begin(), options.iterations.end());
  const int last = *wanted.rbegin();
  const double unit = std::exp2(std::round(std::log2(mean_edge_length(surface.surface))));
  for (int k = 0; k <= last; ++k) {
    const jobs::LevelFields fields = evolving.advance(k < last);
    if (!wanted.contains(k)) continue;
    for (std::size_t v = 0; v < fields.points.size(); ++v)
      surface.points[v].head<3>() = fields.points[v] / static_cast<float>(unit);
    surface.normals = fields.normals;
    surface.prepare();
    use(k, surface, fields.mean_edge_length, unit);
  }
}

std::vector<Measurement> measure(kernels::TriangleMesh mesh, const DirectionOptions& options,
                                 engine::Workers& workers) {
  std::vector<Measurement> result;
  evolve(std::move(mesh), options, workers,
         [&](int iteration, const kernels::PreparedSurface& surface, double edge, double unit) {
           for (const double factor : options.steps) {
             const auto spreads =
                 direction_spreads(surface, static_cast<float>(factor * edge / unit),
                                   coordinates_of(options.coordinates), workers);
             result.push_back({iteration, factor, factor * edge,
                               direction_errors(spreads, 0, options.least),
                               direction_errors(spreads, 1, options.least)});
           }
         });
  return result;
}

/// Says how the errors of the directions of a vertex are summed up. Each way has rows in the CSV
/// and a plot.
struct OverDirections {
  const char* name;
  const char* title;
  DirectionErrors::Summary DirectionErrors::*summary;
};
constexpr OverDirections kOverDirections[] = {
    {"max", "maximum error", &DirectionErrors::max},
    {"min", "minimum error", &DirectionErrors::min},
    {"mean", "average error", &DirectionErrors::average},
};

struct Quantity {
  const char* name;
  const char* title;
  DirectionErrors Measurement::*errors;
};
constexpr Quantity kQuantities[] = {
    {"K", "Gaussian curvature", &Measurement::gaussian},
    {"H", "Mean curvature", &Measurement::mean},
};

std::string csv(const std::vector<Measurement>& measurements) {
  std::string text =
      "iteration,step_factor,step,quantity,over_directions,mean_percent,median_percent,p95_percent,"
      "mean_percent_of_surface,median_percent_of_surface,vertices_used,vertices_near_zero,"
      "vertices_truncated\n";
  for (const Measurement& m : measurements)
    for (const Quantity& quantity : kQuantities)
      for (const OverDirections& over : kOverDirections) {
        const DirectionErrors& e = m.*quantity.errors;
        const DirectionErrors::Summary& s = e.*over.summary;
        char row[320];
        std::snprintf(row, sizeof row,
                      "%d,%.6g,%.6g,%s,%s,%.5g,%.5g,%.5g,%.5g,%.5g,%lld,%lld,%lld\n", m.iteration,
                      m.step_factor, m.step, quantity.name, over.name, s.mean, s.median, s.p95,
                      s.surface_mean, s.surface_median, static_cast<long long>(e.used),
                      static_cast<long long>(e.near_zero), static_cast<long long>(e.truncated));
        text += row;
      }
  return text;
}

Plot plot(const std::vector<Measurement>& measurements, const Quantity& quantity,
          const OverDirections& over, double DirectionErrors::Summary::*statistic) {
  Plot result{std::string(quantity.title) + ", " + over.title,
              "step size, mean edge lengths",
              "error, %",
              {}};
  for (const Measurement& m : measurements) {
    const std::string label = std::to_string(m.iteration);
    if (result.series.empty() || result.series.back().label != label)
      result.series.push_back({label, {}});
    result.series.back().points.emplace_back(m.step_factor,
                                             (m.*quantity.errors).*over.summary.*statistic);
  }
  return result;
}

void write_plots(const fs::path& stem, const std::vector<Measurement>& measurements) {
  struct Statistic {
    const char* suffix;
    double DirectionErrors::Summary::*value;
  };
  for (const Statistic& statistic : {Statistic{"", &DirectionErrors::Summary::mean},
                                     Statistic{"_median", &DirectionErrors::Summary::median}}) {
    std::vector<Plot> all;
    for (const Quantity& quantity : kQuantities)
      for (const OverDirections& over : kOverDirections) {
        all.push_back(plot(measurements, quantity, over, statistic.value));
        io::write_file_atomically(
            stem.string() + "_" + quantity.name + "_" + over.name + statistic.suffix + ".svg",
            bench::svg({all.back()}, 1, "iterations"));
      }
    io::write_file_atomically(stem.string() + statistic.suffix + ".svg",
                              bench::svg(all, 3, "iterations"));
  }
}

void print_table(const std::string& name, const std::vector<Measurement>& measurements) {
  std::printf("%s: average error of the directions, %%, at step factor 1: mean / median\n",
              name.c_str());
  std::printf("  %9s  %-17s  %-17s  %10s %10s %10s\n", "iteration", "K", "H", "used", "near zero",
              "truncated");
  for (const Measurement& m : measurements) {
    if (m.step_factor != 1) continue;
    std::printf("  %9d ", m.iteration);
    for (const Quantity& quantity : kQuantities) {
      const DirectionErrors::Summary& s = (m.*quantity.errors).average;
      std::printf(" %7.3f / %7.3f ", s.mean, s.median);
    }
    const DirectionErrors& k = m.gaussian;
    std::printf(" %10lld %10lld %10lld\n", static_cast<long long>(k.used),
                static_cast<long long>(k.near_zero), static_cast<long long>(k.truncated));
  }
}

int run(const DirectionOptions& options) {
  std::error_code error;
  fs::create_directories(options.output, error);
  if (error)
    throw io::Error(options.output, "", "cannot be created: " + error.message(),
                    "check --output, its permissions and the free space");
  engine::Workers workers(options.threads);
  int exit_code = kDone;
  for (const fs::path& path : options.meshes) {
    try {
      const auto measurements = measure(io::read_scan(path).mesh, options, workers);
      const fs::path stem = options.output / path.stem();
      io::write_file_atomically(stem.string() + ".csv", csv(measurements));
      write_plots(stem, measurements);
      print_table(path.stem().string(), measurements);
    } catch (const io::Error& e) {
      std::fprintf(stderr, "accuracy: %s\n", e.what());
      exit_code = kFailed;
    } catch (const std::runtime_error& e) {
      std::fprintf(stderr, "accuracy: %s: %s\n", path.c_str(), e.what());
      exit_code = kFailed;
    }
  }
  return exit_code;
}

}  // namespace

void add_directions(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DirectionOptions>();
  CLI::App* command = app.add_subcommand(
      "directions", "How much K and H depend on the first direction of the patch (thesis 6.2.1)");
  command->footer(
      "Examples:\n"
      "  accuracy directions foot.ply --output out\n"
      "  accuracy directions *.obj --output out --iterations 0,1,100 --steps 1 --surface flat\n"
      "\n"
      "Writes OUT/<mesh>.csv, plots of the mean over the vertices, OUT/<mesh>.svg (all) and\n"
      "OUT/<mesh>_{K,H}_{max,min,mean}.svg, and of the median, the same with _median.\n");
  command->add_option("meshes", options->meshes, "PLY, OBJ, OFF, STL, each also .gz")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("-o,--output", options->output, "A folder, made if need be")->required();
  command->add_option("--iterations", options->iterations, "Smoothings before the estimate")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0, 9999));
  command
      ->add_option("--steps", options->steps,
                   "Sample distances of the estimate, in mean edge lengths")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(0.05, 20.0));
  command->add_option("--surface", options->surface)->check(CLI::IsMember({"curved", "flat"}));
  command->add_option("--coordinates", options->coordinates)
      ->check(CLI::IsMember({"semigeodesic", "polar"}));
  command
      ->add_option("--least", options->least,
                   "Leave out vertices whose |curvature| is below this share of its median")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--threads", options->threads, "0: one per core")->check(CLI::Range(0, 4096));
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace semigeo::accuracy
