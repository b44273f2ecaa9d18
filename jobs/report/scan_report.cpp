#include "jobs/report/scan_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "io/dataset/dataset_header.hpp"
#include "io/files/base64.hpp"
#include "io/files/error.hpp"
#include "jobs/picture/robust_limit.hpp"
#include "kernels/repair/decimation.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;

/// Bytes of the page for each vertex of a level: points, curvatures, completeness, number of the
/// vertex, two triangles, features and contours; as base64.
constexpr double kBytesPerVertex = 70;

/// The greatest number of vertices of a level: the corners of triangles have 16 bits.
constexpr std::int64_t kMostVertices = 65536;

/// The vertices and triangles of a level that are shown.
struct ShownLevel {
  std::vector<Vector3f> points;
  std::vector<kernels::Triangle> triangles;
  std::vector<std::int32_t> rows;  ///< Row of the level of each vertex; empty if all are shown.
};

ShownLevel read_surface(const io::Dataset& dataset, int level) {
  ShownLevel shown;
  const std::vector<float> points = dataset.read_floats(level, "points");
  for (std::size_t i = 0; i < points.size(); i += 3)
    shown.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  const std::vector<std::int64_t> corners = dataset.read_integers(level, "triangles");
  const auto vertices = static_cast<std::int64_t>(shown.points.size());
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    kernels::Triangle triangle = {};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::int64_t vertex = corners[i + corner];
      if (vertex < 0 || vertex >= vertices)
        throw io::Error(dataset.path(), io::level_path(level) + "/triangles",
                        "has a corner that is no vertex", "make the dataset again");
      triangle[corner] = static_cast<std::int32_t>(vertex);
    }
    shown.triangles.push_back(triangle);
  }
  return shown;
}

/// Decimates a level that has more vertices than may be shown.
void decimate(ShownLevel& shown, std::int64_t vertices) {
  if (static_cast<std::int64_t>(shown.points.size()) <= vertices) return;
  kernels::Surface surface;
  const auto all = static_cast<std::int64_t>(shown.points.size());
  static_cast<kernels::Connectivity&>(surface) = kernels::connect(std::move(shown.triangles), all);
  surface.points = std::move(shown.points);
  surface.part_count = kernels::number_parts(surface, surface.part);
  kernels::DecimatedSurface small =
      kernels::decimate(surface, {.target_vertices = vertices, .measure = false});
  shown.points = std::move(small.surface.points);
  shown.triangles = std::move(small.surface.triangles);
  shown.rows = std::move(small.source_vertex);
}

/// Returns the box of the points as an origin and one size, so that fractions keep proportions.
struct Box {
  Vector3f low = Vector3f::Zero();
  float size = 0;
};

Box box_of(const std::vector<Vector3f>& points) {
  Box box;
  if (points.empty()) return box;
  Vector3f high = points.front();
  box.low = points.front();
  for (const Vector3f& p : points) {
    box.low = box.low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  box.size = (high - box.low).maxCoeff();
  return box;
}

std::vector<std::uint16_t> fractions(const std::vector<Vector3f>& points, const Box& box) {
  constexpr float kMost = std::numeric_limits<std::uint16_t>::max();
  const float scale = box.size > 0 ? kMost / box.size : 0;
  std::vector<std::uint16_t> result;
  for (const Vector3f& p : points)
    for (const float x : (scale * (p - box.low)).eval())
      result.push_back(static_cast<std::uint16_t>(std::clamp(x + 0.5f, 0.0f, kMost)));
  return result;
}

std::vector<float> shown_values(std::vector<float> values, const ShownLevel& shown) {
  return shown.rows.empty() ? std::move(values) : kernels::gathered(values, shown.rows);
}

void add_fields(nlohmann::json& json, const io::Dataset& dataset, int level,
                const ShownLevel& shown) {
  std::vector<float> completeness = dataset.read_floats(level, "patch_completeness");
  for (const auto& [name, array] :
       {std::pair("K", "gaussian_curvature"), std::pair("H", "mean_curvature")}) {
    std::vector<float> values = dataset.read_floats(level, array);
    const std::array<FieldValues, 1> field = {{{values, completeness}}};
    json["limits"][name] = robust_limit(field);
    for (std::size_t v = 0; v < values.size(); ++v)
      if (completeness[v] <= 0) values[v] = std::numeric_limits<float>::quiet_NaN();
    json[name] = io::base64_of(shown_values(std::move(values), shown));
  }
  json["invalid"] = std::ranges::count(completeness, 0.0f);
  std::vector<std::uint8_t> shares;
  for (const float c : shown_values(std::move(completeness), shown))
    shares.push_back(static_cast<std::uint8_t>(255 * std::clamp(c, 0.0f, 1.0f)));
  json["completeness"] = io::base64_of(shares);
}

void add_surface(nlohmann::json& json, const ShownLevel& shown, const Box& box) {
  json["low"] = {box.low.x(), box.low.y(), box.low.z()};
  json["size"] = box.size;
  json["shown_vertices"] = shown.points.size();
  json["points"] = io::base64_of(fractions(shown.points, box));
  if (!shown.rows.empty()) json["rows"] = io::base64_of(shown.rows);
  std::vector<std::uint16_t> corners;
  for (const kernels::Triangle& triangle : shown.triangles)
    for (const std::int32_t corner : triangle)
      corners.push_back(static_cast<std::uint16_t>(corner));
  json["triangles"] = io::base64_of(corners);
}

/// Adds the most prominent features of each kind, at most as many of a kind as an eighth of the
/// vertices that are shown.
void add_features(nlohmann::json& json, kernels::FeaturesByKind features, const ShownLevel& shown,
                  const Box& box) {
  const std::size_t most = std::max<std::size_t>(64, shown.points.size() / 8);
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind) {
    std::vector<kernels::Feature>& all = features[kind];
    const std::size_t count = all.size();
    std::ranges::stable_sort(all, std::ranges::greater(), &kernels::Feature::prominence);
    all.resize(std::min(count, most));
    std::vector<Vector3f> points;
    for (const kernels::Feature& feature : all) points.push_back(feature.position);
    json["features"][kernels::kFeatureKindNames[kind]] = {
        {"count", count}, {"points", io::base64_of(fractions(points, box))}};
  }
}

/// Adds contours as segments between every `stride`-th of their points.
void add_contours(nlohmann::json& json, const io::Dataset& dataset, int level,
                  const ShownLevel& shown, const Box& box) {
  for (int kind = 0; kind < kernels::kContourKinds; ++kind) {
    const kernels::SampledContours contours =
        dataset.read_contours(level, static_cast<kernels::FeatureKind>(kind));
    const std::size_t most = std::max<std::size_t>(64, shown.points.size() / 2);
    const auto stride = static_cast<std::int64_t>(1 + contours.points.size() / most);
    std::vector<Vector3f> points;
    std::vector<std::uint32_t> offsets = {0};
    for (std::int64_t c = 0; c < contours.count(); ++c) {
      const std::int64_t first = contours.offsets[c];
      const std::int64_t last = contours.offsets[c + 1] - 1;
      if (last - first < stride && stride > 1) continue;  // too short to be seen
      for (std::int64_t p = first; p < last; p += stride) points.push_back(contours.points[p]);
      points.push_back(contours.points[last]);
      if (contours.closed[c] != 0) points.push_back(contours.points[first]);
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    json["contours"][kernels::kFeatureKindNames[kind]] = {
        {"count", contours.count()},
        {"points", io::base64_of(fractions(points, box))},
        {"offsets", io::base64_of(offsets)}};
  }
}

nlohmann::json level_json(const io::Dataset& dataset, int level, std::int64_t vertices) {
  const io::LevelInfo info = dataset.level(level);
  nlohmann::json json = {{"level", level},
                         {"scale", info.scale},
                         {"step", info.step},
                         {"mean_edge_length", info.mean_edge_length},
                         {"vertices", info.vertices},
                         {"triangle_count", info.triangles},
                         {"parts", info.parts}};
  ShownLevel shown = read_surface(dataset, level);
  decimate(shown, vertices);
  const Box box = box_of(shown.points);
  add_surface(json, shown, box);
  add_fields(json, dataset, level, shown);
  add_features(json, dataset.read_features(level), shown, box);
  add_contours(json, dataset, level, shown, box);
  return json;
}

/// Returns the levels that are shown: the first, the last, the one of recognition, and others at
/// even distances.
std::set<int> shown_levels(const io::Dataset& dataset, std::int64_t most) {
  const int count = dataset.level_count();
  std::set<int> levels = {static_cast<int>(dataset.selection().level)};
  const auto steps =
      static_cast<int>(std::min<std::int64_t>(count, std::max<std::int64_t>(2, most)));
  for (int i = 0; i < steps; ++i)
    levels.insert(steps == 1 ? 0 : static_cast<int>(std::int64_t{i} * (count - 1) / (steps - 1)));
  return levels;
}

}  // namespace

nlohmann::json scan_report(const io::Dataset& dataset, const ScanPageLimits& limits) {
  const io::DatasetHeader& header = dataset.header();
  const io::Selection selection = dataset.selection();
  const std::set<int> chosen = shown_levels(dataset, limits.levels);
  const auto vertices = std::min({kMostVertices, limits.vertices,
                                  static_cast<std::int64_t>(limits.bytes / kBytesPerVertex /
                                                            static_cast<double>(chosen.size()))});
  nlohmann::json levels = nlohmann::json::array();
  for (const int level : chosen) levels.push_back(level_json(dataset, level, vertices));
  return {{"title", header.input_name},
          {"file", dataset.path().filename().string()},
          {"unit", header.length_unit},
          {"origin", header.origin},
          {"parameters", header.parameters},
          {"repairs", header.repairs},
          {"preparation", header.preparation},
          {"input_xxh3", header.input_xxh3},
          {"digest", dataset.digest()},
          {"creator_version", dataset.creator_version()},
          {"level_count", dataset.level_count()},
          {"level", selection.level},
          {"chosen", io::name_of(selection.chosen)},
          {"feature_counts", selection.feature_counts},
          {"levels", std::move(levels)}};
}

}  // namespace semigeo::jobs
