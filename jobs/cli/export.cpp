#include <cstdio>
#include <memory>

#include "io/dataset.hpp"
#include "io/error.hpp"
#include "io/mesh_writer.hpp"
#include "jobs/cli/command.hpp"

namespace semigeo::jobs::cli {
namespace {

struct ExportOptions {
  std::string dataset;
  int level = 0;
  std::string output;
  std::string quality = "mean_curvature";
};

int export_level(const ExportOptions& options) {
  const io::Dataset dataset(options.dataset);
  if (options.level >= dataset.level_count())
    throw io::Error(
        options.dataset, "level " + std::to_string(options.level),
        "does not exist; there are " + std::to_string(dataset.level_count()) + " levels",
        "give --level 0 to " + std::to_string(dataset.level_count() - 1));
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
  std::printf("%s: %zu vertices, %zu triangles, quality = %s\n", options.output.c_str(),
              points.size() / 3, triangles.size() / 3, options.quality.c_str());
  return kAllDone;
}

}  // namespace

void add_export(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Write one level as a binary PLY with normals and curvatures");
  command->footer(
      "Examples:\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --level 4 --output smooth.ply\n"
      "  semigeo export archive/scans/x.ply.vtkhdf --output k.ply --quality gaussian_curvature\n"
      "\n"
      "The `quality` is what MeshLab and CloudCompare colour by.\n");
  command->add_option("dataset", options->dataset, "A dataset")->required();
  command->add_option("--level", options->level, "Scale level")->check(CLI::Range(0, 999));
  command->add_option("-o,--output", options->output, "The PLY file to write")->required();
  command->add_option("--quality", options->quality, "Field that becomes `quality`")
      ->check(CLI::IsMember({"gaussian_curvature", "mean_curvature", "patch_completeness",
                             "principal_curvature_1", "principal_curvature_2"}));
  command->callback([options, &exit_code] { exit_code = export_level(*options); });
}

}  // namespace semigeo::jobs::cli
