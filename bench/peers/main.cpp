// Curvature and descriptors of other libraries beside ours: time, accuracy, and how well scans of
// one object agree.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>

#include "bench/peers/report.hpp"
#include "bench/support/examples_first.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::peers {
namespace {

constexpr int kLastLevel = 8;
/// A vertex is compared if it lies so many edges inside.
constexpr int kInside = 10;

struct Options {
  std::filesystem::path scans = SEMIGEO_REAL_SCANS;
  std::filesystem::path range;
  std::filesystem::path json;
  std::filesystem::path chart;
  int rounds = 5;
};

std::vector<Library> libraries() {
  std::vector<Library> result{ours()};
#ifdef SEMIGEO_PEERS_CGAL
  result.push_back(cgal());
#else
  result.push_back({"CGAL", "libcgal-dev", "", {}});
#endif
#ifdef SEMIGEO_PEERS_PCL
  result.push_back(point_cloud_library());
#else
  result.push_back({"PCL", "libpcl-dev", "", {}});
#endif
#ifdef SEMIGEO_PEERS_OPENCV
  result.push_back(opencv());
#else
  result.push_back({"OpenCV", "libopencv-contrib-dev", "", {}});
#endif
  return result;
}

/// Returns the named analytic surface as a subject.
Subject analytic(const std::string& name, shapes::Tessellation tessellation, int vertices) {
  for (const shapes::AnalyticSurface& surface : shapes::analytic_surfaces()) {
    if (surface.name != name) continue;
    shapes::AnalyticMesh mesh = shapes::tessellate(surface, tessellation, vertices);
    std::string title =
        name_of(tessellation) + (" " + name) + ", " + std::to_string(mesh.mesh.points.size());
    return make_subject(std::move(title), std::move(mesh.mesh), std::move(mesh.truth));
  }
  throw std::logic_error("no surface " + name);
}

std::vector<Subject> subjects(const std::filesystem::path& scans) {
  using shapes::Tessellation;
  std::vector<Subject> result;
  result.push_back(analytic("sphere", Tessellation::kEven, 10'242));
  result.push_back(analytic("sphere", Tessellation::kEven, 40'962));
  result.push_back(analytic("torus", Tessellation::kUneven, 40'000));
  for (const char* file : {"os_skull.obj", "uwa_parasaurolophus_28k.ply"}) {
    if (!std::filesystem::exists(scans / file)) {
      std::fprintf(stderr, "peers: %s is not there and left out\n", (scans / file).c_str());
      continue;
    }
    Subject subject = make_subject("", io::read_scan(scans / file).mesh);
    subject.name =
        (scans / file).stem().string() + ", " + std::to_string(subject.surface.vertex_count());
    result.push_back(std::move(subject));
  }
  return result;
}

/// Compares the views of the bunny, by ours and by jets of several radii.
std::vector<AgreementRow> agreement_rows(const std::filesystem::path& folder) {
  const ViewsOfOneObject views(folder, bunny_views(), kLastLevel, kInside);
  std::vector<AgreementRow> rows = views.levels();
#ifdef SEMIGEO_PEERS_CGAL
  for (const double radius : {2., 2.3, 2.6, 3., 3.5, 4., 5., 6., 7., 8., 9.})
    rows.push_back(views.jets(2, radius));
  for (const double radius : {3., 3.5, 4., 5., 6., 7., 8., 10., 12., 14.})
    rows.push_back(views.jets(4, radius));
#endif
  return rows;
}

void write(const std::filesystem::path& path, const std::string& text) {
  if (path.empty()) return;
  std::ofstream file(path, std::ios::binary);
  if (!(file << text << std::flush)) throw std::runtime_error("cannot write " + path.string());
}

void run(const Options& options) {
  Report report;
  report.libraries = libraries();
  report.rounds = options.rounds;
  if (!options.range.empty()) report.agreement = agreement_rows(options.range);
  if (options.rounds > 0)
    for (const Subject& subject : subjects(options.scans))
      for (MethodRow& row : compare_methods(subject, report.libraries, options.rounds))
        report.methods.push_back(std::move(row));
  std::fputs(markdown(report).c_str(), stdout);
  write(options.json, json(report));
  if (!report.agreement.empty()) write(options.chart, chart(report));
}

}  // namespace
}  // namespace semigeo::peers

int main(int argc, char** argv) {
  using namespace semigeo::peers;
  CLI::App app{"Curvature and descriptors of other libraries beside ours, on one thread.", "peers"};
  app.formatter(std::make_shared<semigeo::bench::ExamplesFirst>());
  app.footer(
      "Examples:\n"
      "  peers                                            time and accuracy\n"
      "  peers --range range --json peers.json            also how well views of one object "
      "agree\n");
  app.option_defaults()->always_capture_default();
  Options options;
  app.add_option("--scans", options.scans, "Folder with the real meshes")->type_name("DIR");
  app.add_option("--range", options.range, "Folder with bun000, bun090 and top3 as .ply.gz")
      ->type_name("DIR")
      ->check(CLI::ExistingDirectory);
  app.add_option("--rounds", options.rounds, "Runs of each method; 0: agreement alone")
      ->check(CLI::Range(0, 1000));
  app.add_option("--json", options.json, "Write the numbers as JSON")->type_name("FILE");
  app.add_option("--chart", options.chart, "Draw the agreement as SVG")->type_name("FILE");
  try {
    app.parse(argc, argv);
    run(options);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "peers: %s\n", e.what());
    return 1;
  }
  return 0;
}
