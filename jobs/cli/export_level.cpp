#include "jobs/cli/export_level.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/files/npz_file.hpp"
#include "io/scans/feature_writer.hpp"
#include "io/scans/glb_writer.hpp"
#include "io/scans/mesh_writer.hpp"
#include "io/scans/obj_writer.hpp"
#include "io/scans/stl_writer.hpp"
#include "io/scans/vtp_writer.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/picture/robust_limit.hpp"

namespace semigeo::jobs::cli {
namespace {

using kernels::FeatureKind;
using kernels::kFeatureKindNames;
using kernels::kFeatureKinds;

/// The arrays of a level, which views refer to.
struct LevelArrays {
  std::vector<float> points;
  std::vector<float> normals;
  std::vector<std::int64_t> triangles;
  std::vector<std::pair<std::string, std::vector<float>>> scalars;
  std::vector<std::pair<std::string, std::vector<std::int64_t>>> integers;
  std::vector<std::uint8_t> colours;
};

std::string export_features(const io::Dataset& dataset, int level,
                            const std::filesystem::path& output, const LevelExport& what) {
  const auto features = dataset.read_features(level);
  std::vector<io::FeaturesView> tables;
  std::size_t count = 0;
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    if (what.features != "all" && what.features != kFeatureKindNames[kind]) continue;
    tables.push_back({FeatureKind(kind), features[kind]});
    count += features[kind].size();
  }
  const auto write =
      what.format == ExportFormat::kPly ? io::write_features_ply : io::write_features_csv;
  write(output, tables, dataset.header().origin);
  return line_of(output, ": ", count, " features, kind = ", what.features, "\n");
}

std::string export_contours(const io::Dataset& dataset, int level,
                            const std::filesystem::path& output, const LevelExport& what) {
  const bool gaussian = what.contours == kFeatureKindNames[0];
  const kernels::SampledContours contours =
      dataset.read_contours(level, gaussian ? FeatureKind::kGaussian : FeatureKind::kMean);
  const auto write =
      what.format == ExportFormat::kPly ? io::write_contours_ply : io::write_contours_csv;
  write(output, contours, dataset.header().origin);
  return line_of(output, ": ", contours.closed.size(), " contours ", gaussian ? "K" : "H", " = 0, ",
                 contours.points.size(), " points\n");
}

/// Returns the colours of a field, symmetric about zero; grey where it is not valid.
std::vector<std::uint8_t> colours_of(std::vector<float> values,
                                     const std::vector<float>& completeness, ColourScale scale) {
  const std::array<FieldValues, 1> field = {{{values, completeness}}};
  const float limit = robust_limit(field);
  std::vector<std::uint8_t> colours;
  for (std::size_t v = 0; v < values.size(); ++v) {
    const float value = completeness[v] > 0 ? values[v] / (limit > 0 ? limit : 1)
                                            : std::numeric_limits<float>::quiet_NaN();
    for (const float part : colour_of(scale, value))
      colours.push_back(static_cast<std::uint8_t>(255 * part + 0.5f));
  }
  return colours;
}

/// Adds all fields of the level that have one number for each vertex.
void add_all_fields(LevelArrays& arrays, const io::Dataset& dataset, int level) {
  std::vector<const char*> names = {"gaussian_curvature", "mean_curvature", "patch_completeness"};
  if (dataset.has_principal())
    names.insert(names.end(), {"principal_curvature_1", "principal_curvature_2"});
  for (const char* name : names)
    arrays.scalars.emplace_back(name, dataset.read_floats(level, name));
  std::vector<const char*> whole = {"part", "source_vertex"};
  if (dataset.has_filled()) whole.push_back("vertex_filled");
  for (const char* name : whole)
    arrays.integers.emplace_back(name, dataset.read_integers(level, name));
}

LevelArrays read_arrays(const io::Dataset& dataset, int level, const LevelExport& what) {
  LevelArrays arrays;
  arrays.points = dataset.read_floats(level, "points");
  arrays.normals = dataset.read_floats(level, "normals");
  arrays.triangles = dataset.read_integers(level, "triangles");
  const bool ply = what.format == ExportFormat::kPly;
  if (ply && what.dialect == Dialect::kNone) {
    for (const char* name : {"gaussian_curvature", "mean_curvature"})
      arrays.scalars.emplace_back(name, dataset.read_floats(level, name));
  } else {
    add_all_fields(arrays, dataset, level);
  }
  if (ply && (what.dialect == Dialect::kNone || what.dialect == Dialect::kMeshlab))
    arrays.scalars.emplace_back("quality", dataset.read_floats(level, what.quality));
  if (ply && what.dialect == Dialect::kCloudcompare) {
    for (auto& [name, values] : arrays.scalars) name.insert(0, "scalar_");
    for (auto& [name, values] : arrays.integers) name.insert(0, "scalar_");
  }
  const bool coloured =
      what.format == ExportFormat::kObj || what.format == ExportFormat::kGlb ||
      (ply && (what.dialect == Dialect::kMeshlab || what.dialect == Dialect::kBlender));
  if (coloured)
    arrays.colours = colours_of(dataset.read_floats(level, what.quality),
                                dataset.read_floats(level, "patch_completeness"), what.scale);
  return arrays;
}

io::MeshView view_of(const LevelArrays& arrays, const std::array<double, 3>& origin) {
  io::MeshView mesh;
  mesh.points = arrays.points;
  mesh.normals = arrays.normals;
  mesh.triangles = arrays.triangles;
  for (const auto& [name, values] : arrays.scalars) mesh.scalars.push_back({name, values});
  for (const auto& [name, values] : arrays.integers) mesh.integers.push_back({name, values});
  mesh.colours = arrays.colours;
  mesh.origin = origin;
  return mesh;
}

/// Adds the features of a level, those of all kinds one after the other.
void add_features(io::NpzFile& file, const kernels::FeaturesByKind& features) {
  std::vector<std::int64_t> kinds;
  std::vector<std::int64_t> vertices;
  std::vector<float> values;
  std::vector<float> prominences;
  std::vector<float> positions;
  std::vector<float> normals;
  for (int kind = 0; kind < kFeatureKinds; ++kind)
    for (const kernels::Feature& feature : features[kind]) {
      kinds.push_back(kind);
      vertices.push_back(feature.vertex);
      values.push_back(feature.value);
      prominences.push_back(feature.prominence);
      positions.insert(positions.end(), feature.position.begin(), feature.position.end());
      normals.insert(normals.end(), feature.normal.begin(), feature.normal.end());
    }
  file.add("feature_kind", kinds);
  file.add("feature_vertex", vertices);
  file.add("feature_value", values);
  file.add("feature_prominence", prominences);
  file.add("feature_position", positions, 3);
  file.add("feature_normal", normals, 3);
}

void write_npz(const std::filesystem::path& path, const LevelArrays& arrays,
               const io::Dataset& dataset, int level) {
  io::NpzFile file(path);
  file.add("points", arrays.points, 3);
  file.add("normals", arrays.normals, 3);
  file.add("triangles", arrays.triangles, 3);
  for (const auto& [name, values] : arrays.scalars) file.add(name, values);
  for (const auto& [name, values] : arrays.integers) file.add(name, values);
  if (dataset.has_principal())
    for (const char* name : {"principal_direction_1", "principal_direction_2"})
      file.add(name, dataset.read_floats(level, name), 3);
  add_features(file, dataset.read_features(level));
  file.add("origin", std::span<const double>(dataset.header().origin));
  file.add_number("level", level);
  file.add_number("scale", dataset.scale(level));
  file.add_text("length_unit", dataset.header().length_unit);
  file.commit();
}

std::string export_surface(const io::Dataset& dataset, int level,
                           const std::filesystem::path& output, const LevelExport& what) {
  if (what.quality.starts_with("principal") && !dataset.has_principal())
    throw io::Error(dataset.path(), "", "has no principal curvatures",
                    "run with --principal, or export another --quality");
  const LevelArrays arrays = read_arrays(dataset, level, what);
  // What Blender reads are floats, in which map coordinates lose their digits.
  const bool relative = what.dialect == Dialect::kBlender || what.format == ExportFormat::kStl;
  const std::array<double, 3>& origin = dataset.header().origin;
  const io::MeshView mesh = view_of(arrays, relative ? std::array<double, 3>{} : origin);
  switch (what.format) {
    case ExportFormat::kObj:
      io::write_obj(output, mesh, "written by semigeo; colours: " + what.quality);
      break;
    case ExportFormat::kStl:
      io::write_stl(output, mesh);
      break;
    case ExportFormat::kGlb:
      io::write_glb(output, mesh, dataset.header().length_unit);
      break;
    case ExportFormat::kVtp:
      io::write_vtp(output, mesh);
      break;
    case ExportFormat::kNpz:
      write_npz(output, arrays, dataset, level);
      break;
    default:
      io::write_ply(output, mesh);
  }
  std::string line = line_of(output, ": ", arrays.points.size() / 3, " vertices, ",
                             arrays.triangles.size() / 3, " triangles");
  const bool has_quality = std::ranges::any_of(
      arrays.scalars, [](const auto& scalars) { return scalars.first == "quality"; });
  if (has_quality) line += ", quality = " + what.quality;
  if (relative && origin != std::array<double, 3>{})
    line += line_of(", relative to ", origin[0] + 0.0, " ", origin[1] + 0.0, " ", origin[2] + 0.0);
  return line + "\n";
}

}  // namespace

std::optional<ExportFormat> format_of_extension(const std::string& extension) {
  for (std::size_t i = 0; i < kExportFormats.size(); ++i)
    if (kExportFormats[i].extension == io::lower_case(extension))
      return static_cast<ExportFormat>(i);
  return std::nullopt;
}

std::string export_level(const io::Dataset& dataset, int level, const std::filesystem::path& output,
                         const LevelExport& what) {
  if (!what.features.empty()) return export_features(dataset, level, output, what);
  if (!what.contours.empty()) return export_contours(dataset, level, output, what);
  return export_surface(dataset, level, output, what);
}

}  // namespace semigeo::jobs::cli
