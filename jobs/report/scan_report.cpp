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
#include "jobs/picture/curvature_unit.hpp"
#include "jobs/picture/robust_limit.hpp"
#include "jobs/report/shown_surface.hpp"
#include "kernels/surface/vertex_rows.hpp"

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;

/// Bytes of the page for each vertex of a level: points, curvatures, completeness, number of the
/// vertex, two triangles, features and contours; as base64.
constexpr double kBytesPerVertex = 70;

/// Returns whether a vertex has a valid patch. Damaged datasets may hold NaN.
bool is_valid(float completeness) {
  return completeness > 0;
}

/// Counts the values of valid vertices in equal bins between -limit and limit. The outer bins also
/// have what lies beyond.
std::vector<std::int64_t> histogram(const std::vector<float>& values,
                                    const std::vector<float>& completeness, float limit) {
  constexpr int kBins = 48;
  std::vector<std::int64_t> counts(kBins);
  for (std::size_t v = 0; v < values.size(); ++v) {
    if (!is_valid(completeness[v]) || !std::isfinite(values[v])) continue;
    const float place = limit > 0 ? (values[v] / limit + 1) / 2 * kBins : kBins * 0.5f;
    ++counts[static_cast<std::size_t>(std::clamp(place, 0.0f, kBins - 1.0f))];
  }
  return counts;
}

std::vector<float> shown_values(std::vector<float> values, const ShownSurface& shown) {
  return shown.rows.empty() ? std::move(values) : kernels::gathered(values, shown.rows);
}

void add_fields(nlohmann::json& json, const io::Dataset& dataset, int level,
                const ShownSurface& shown) {
  std::vector<float> completeness = dataset.read_floats(level, "patch_completeness");
  for (const auto& [name, array] :
       {std::pair("K", "gaussian_curvature"), std::pair("H", "mean_curvature")}) {
    std::vector<float> values = dataset.read_floats(level, array);
    const std::array<FieldValues, 1> field = {{{values, completeness}}};
    const float limit = robust_limit(field);
    json["limits"][name] = limit;
    json["histograms"][name] = histogram(values, completeness, limit);
    for (std::size_t v = 0; v < values.size(); ++v)
      if (!is_valid(completeness[v])) values[v] = std::numeric_limits<float>::quiet_NaN();
    json[name] = io::base64_of(shown_values(std::move(values), shown));
  }
  json["invalid"] = std::ranges::count(completeness, false, is_valid);
  std::vector<std::uint8_t> shares;
  for (const float c : shown_values(std::move(completeness), shown))
    shares.push_back(static_cast<std::uint8_t>(is_valid(c) ? 255 * std::min(c, 1.0f) : 0.0f));
  json["completeness"] = io::base64_of(shares);
}

/// Adds the most prominent features of each kind, at most as many of a kind as an eighth of the
/// vertices that are shown.
void add_features(nlohmann::json& json, kernels::FeaturesByKind features, const ShownSurface& shown,
                  const ShownBox& box) {
  const std::size_t most = std::max<std::size_t>(64, shown.points.size() / 8);
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind) {
    std::vector<kernels::Feature>& all = features[kind];
    const std::size_t count = all.size();
    std::ranges::stable_sort(all, std::ranges::greater(), &kernels::Feature::prominence);
    all.resize(std::min(count, most));
    std::vector<Vector3f> points;
    points.reserve(all.size());
    for (const kernels::Feature& feature : all) points.push_back(feature.position);
    json["features"][kernels::kFeatureKindNames[kind]] = {
        {"count", count}, {"points", io::base64_of(fractions(points, box))}};
  }
}

/// Adds contours as segments between every `stride`-th of their points.
void add_contours(nlohmann::json& json, const io::Dataset& dataset, int level,
                  const ShownSurface& shown, const ShownBox& box) {
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
  const ShownSurface shown = decimated(read_shown_surface(dataset, level), vertices);
  const ShownBox box = box_of(shown.points);
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
  const auto vertices = std::min({kMostShownVertices, limits.vertices,
                                  static_cast<std::int64_t>(limits.bytes / kBytesPerVertex /
                                                            static_cast<double>(chosen.size()))});
  nlohmann::json levels = nlohmann::json::array();
  for (const int level : chosen) levels.push_back(level_json(dataset, level, vertices));
  std::vector<double> scales;
  scales.reserve(static_cast<std::size_t>(dataset.level_count()));
  for (int level = 0; level < dataset.level_count(); ++level)
    scales.push_back(dataset.scale(level));
  const CurvatureUnits units = curvature_units(header.length_unit);
  return {{"title", header.input_name},
          {"file", dataset.path().filename().string()},
          {"unit", header.length_unit},
          {"curvature_units", {{"H", units.mean}, {"K", units.gaussian}}},
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
          {"scales", std::move(scales)},
          {"levels", std::move(levels)}};
}

}  // namespace semigeo::jobs
