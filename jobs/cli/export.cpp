#include <memory>
#include <string>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/scans/feature_writer.hpp"
#include "io/scans/mesh_writer.hpp"
#include "jobs/cli/chosen_level.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

using kernels::FeatureKind;
using kernels::kFeatureKindNames;
using kernels::kFeatureKinds;

struct ExportOptions {
  std::string dataset;
  int level = 0;
  std::string output;
  std::string quality = "mean_curvature";
  std::string features;  ///< A kind of feature, or "all".
  std::string contours;  ///< A kind of contour.
};

enum class OutputFormat { kPly, kCsv };

/// Returns the format that the extension names. A surface cannot be written as CSV.
OutputFormat format_of(const ExportOptions& options) {
  const bool surface = options.features.empty() && options.contours.empty();
  const std::string extension =
      io::lower_case(std::filesystem::path(options.output).extension().string());
  if (extension == ".ply") return OutputFormat::kPly;
  if (extension == ".csv" && !surface) return OutputFormat::kCsv;
  throw CLI::ValidationError("--output", options.output + " does not say how to write it: " +
                                             (surface ? "give a name that ends in .ply"
                                                      : "give a name that ends in .ply or .csv"));
}

void export_features(const io::Dataset& dataset, const ExportOptions& options,
                     OutputFormat format) {
  const auto features = dataset.read_features(options.level);
  std::vector<io::FeaturesView> tables;
  std::size_t count = 0;
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    if (options.features != "all" && options.features != kFeatureKindNames[kind]) continue;
    tables.push_back({FeatureKind(kind), features[kind]});
    count += features[kind].size();
  }
  const auto write = format == OutputFormat::kPly ? io::write_features_ply : io::write_features_csv;
  write(options.output, tables, dataset.header().origin);
  print(options.output, ": ", count, " features, kind = ", options.features, "\n");
}

void export_contours(const io::Dataset& dataset, const ExportOptions& options,
                     OutputFormat format) {
  const bool gaussian = options.contours == kFeatureKindNames[0];
  const kernels::SampledContours contours =
      dataset.read_contours(options.level, gaussian ? FeatureKind::kGaussian : FeatureKind::kMean);
  const auto write = format == OutputFormat::kPly ? io::write_contours_ply : io::write_contours_csv;
  write(options.output, contours, dataset.header().origin);
  print(options.output, ": ", contours.closed.size(), " contours ", gaussian ? "K" : "H", " = 0, ",
        contours.points.size(), " points\n");
}

void export_surface(const io::Dataset& dataset, const ExportOptions& options) {
  if (options.quality.starts_with("principal") && !dataset.has_principal())
    throw io::Error(options.dataset, "", "has no principal curvatures",
                    "run with --principal, or export another --quality");
  const auto points = dataset.read_floats(options.level, "points");
  const auto normals = dataset.read_floats(options.level, "normals");
  const auto triangles = dataset.read_integers(options.level, "triangles");
  const auto gaussian = dataset.read_floats(options.level, "gaussian_curvature");
  const auto mean = dataset.read_floats(options.level, "mean_curvature");
  const auto quality = dataset.read_floats(options.level, options.quality);
  io::MeshView mesh;
  mesh.points = points;
  mesh.normals = normals;
  mesh.triangles = triangles;
  mesh.scalars = {{"gaussian_curvature", gaussian}, {"mean_curvature", mean}, {"quality", quality}};
  mesh.origin = dataset.header().origin;
  io::write_ply(options.output, mesh);
  print(options.output, ": ", points.size() / 3, " vertices, ", triangles.size() / 3,
        " triangles, quality = ", options.quality, "\n");
}

int export_level(const ExportOptions& options) {
  const OutputFormat format = format_of(options);
  const io::Dataset dataset(options.dataset);
  require_level(dataset, options.level);
  if (!options.features.empty()) {
    export_features(dataset, options, format);
  } else if (!options.contours.empty()) {
    export_contours(dataset, options, format);
  } else {
    export_surface(dataset, options);
  }
  return kAllDone;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write one level as a binary PLY with normals and curvatures, or its features or contours");
  command->footer(
      "Examples:\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --output k.ply --quality gaussian_curvature\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --features all --output f.csv\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --contours mean --output lines.ply\n"
      "\n"
      "The `quality` is what MeshLab and CloudCompare colour by. Features and contours are\n"
      "written as PLY (points; points and edges) or CSV, by the extension of --output.\n");
  command->add_option("dataset", options->dataset, "A dataset")->required();
  command->add_option("--level", options->level, "Scale level")->check(CLI::Range(0, 999));
  command->add_option("-o,--output", options->output, "The file to write")->required();
  CLI::Option* quality =
      command->add_option("--quality", options->quality, "Field that becomes `quality`")
          ->check(CLI::IsMember({"gaussian_curvature", "mean_curvature", "patch_completeness",
                                 "principal_curvature_1", "principal_curvature_2"}));
  CLI::Option* features =
      command
          ->add_option("--features", options->features,
                       "Features of this kind instead of the surface: maxima of |K|, of |H|, of "
                       "torsion along K = 0, along H = 0")
          ->check(CLI::IsMember({"gaussian", "mean", "gaussian_torsion", "mean_torsion", "all"}))
          ->excludes(quality);
  command
      ->add_option("--contours", options->contours,
                   "Contours K = 0 (gaussian) or H = 0 (mean) instead of the surface")
      ->check(CLI::IsMember({"gaussian", "mean"}))
      ->excludes(quality)
      ->excludes(features);
  command->callback([options, &exit_code] { exit_code = export_level(*options); });
}

}  // namespace semigeo::jobs::cli
