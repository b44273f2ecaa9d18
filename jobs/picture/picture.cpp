#include "jobs/picture/picture.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "io/dataset/dataset_header.hpp"
#include "io/files/printable.hpp"
#include "jobs/picture/curvature_unit.hpp"
#include "jobs/picture/legend.hpp"
#include "jobs/picture/read_triangles.hpp"
#include "jobs/picture/renderer.hpp"
#include "jobs/picture/robust_limit.hpp"

namespace semigeo::jobs {
namespace {

constexpr Colour kWhite = {1, 1, 1};
/// Colours of the kinds of features, and of the contours K = 0 and H = 0. They differ in lightness.
constexpr std::array<Colour, kernels::kFeatureKinds> kFeatureColours = {
    {{1, 1, 1}, {0.99f, 0.86f, 0.1f}, {0.15f, 0.75f, 0.5f}, {0.8f, 0.2f, 0.65f}}};
constexpr std::array<Colour, kernels::kContourKinds> kContourColours = {
    {{0.05f, 0.4f, 0.2f}, {0.1f, 0.1f, 0.1f}}};

/// Bounds of a panel's width, in multiples of its height.
constexpr float kNarrowestPanel = 0.6f;
constexpr float kWidestPanel = 2;

/// The arrays of a level that a picture shows.
struct ShownLevel {
  std::vector<float> points;
  std::vector<float> normals;
  std::vector<std::int64_t> triangles;
  std::vector<float> values;  ///< Empty without a field.
  std::vector<float> completeness;
};

ShownLevel read_level(const io::Dataset& dataset, int level, PictureField field) {
  ShownLevel shown = {.points = dataset.read_floats(level, "points"),
                      .normals = dataset.read_floats(level, "normals"),
                      .triangles = {},
                      .values = {},
                      .completeness = {}};
  shown.triangles = read_triangles(dataset, level, shown.points.size() / 3);
  if (field == PictureField::kNone) return shown;
  shown.values = dataset.read_floats(
      level, field == PictureField::kMean ? "mean_curvature" : "gaussian_curvature");
  shown.completeness = dataset.read_floats(level, "patch_completeness");
  return shown;
}

float limit_of(const std::vector<ShownLevel>& levels, const PictureOptions& options) {
  if (options.field == PictureField::kNone) return 0;
  if (options.limit) return static_cast<float>(*options.limit);
  std::vector<FieldValues> fields;
  fields.reserve(levels.size());
  for (const ShownLevel& level : levels) fields.push_back({level.values, level.completeness});
  return robust_limit(fields);
}

std::vector<DrawnLine> lines_of(const io::Dataset& dataset, int level,
                                const PictureOptions& options) {
  std::vector<DrawnLine> lines;
  for (int kind = 0; kind < kernels::kContourKinds; ++kind) {
    if (!options.contours[kind]) continue;
    const kernels::SampledContours contours =
        dataset.read_contours(level, static_cast<kernels::FeatureKind>(kind));
    for (std::int64_t c = 0; c < contours.count(); ++c) {
      DrawnLine line = {{contours.points.begin() + contours.offsets[c],
                         contours.points.begin() + contours.offsets[c + 1]},
                        kContourColours[kind]};
      if (contours.closed[c] != 0) line.points.push_back(line.points.front());
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

std::vector<DrawnMark> marks_of(const io::Dataset& dataset, int level,
                                const PictureOptions& options) {
  std::vector<DrawnMark> marks;
  if (std::ranges::none_of(options.features, [](bool shown) { return shown; })) return marks;
  const kernels::FeaturesByKind features = dataset.read_features(level);
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    if (options.features[kind])
      for (const kernels::Feature& feature : features[kind])
        marks.push_back({feature.position, kFeatureColours[kind]});
  return marks;
}

/// Copies a panel into the picture.
void place(io::Image& image, const io::Image& panel, int x, int y) {
  for (int row = 0; row < panel.height; ++row)
    std::copy_n(&panel.rgba[panel.at(0, row)], 4 * panel.width, &image.rgba[image.at(x, y + row)]);
}

/// Adds to the legend what the colours of a field mean.
void explain_field(Legend& legend, const io::Dataset& dataset, PictureField field) {
  if (field == PictureField::kNone) return;
  const bool mean = field == PictureField::kMean;
  const CurvatureUnits units = curvature_units(dataset.header().length_unit);
  legend.title = mean ? "H in " + units.mean : "K in " + units.gaussian;
  legend.upper = mean ? "concave" : "dome or bowl";
  legend.lower = mean ? "convex" : "saddle";
}

/// Returns what stands beside the panels.
Legend legend_of(const io::Dataset& dataset, const PictureOptions& options, double limit) {
  Legend legend;
  legend.size = options.size;
  legend.scale = options.scale;
  legend.limit = limit;
  explain_field(legend, dataset, options.field);
  static constexpr std::array<const char*, kernels::kFeatureKinds> kFeatureTexts = {
      "maximum of |K|", "maximum of |H|", "torsion on K = 0", "torsion on H = 0"};
  static constexpr std::array<const char*, kernels::kContourKinds> kContourTexts = {"K = 0",
                                                                                    "H = 0"};
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    if (options.features[kind])
      legend.keys.push_back({kFeatureTexts[kind], kFeatureColours[kind], LegendKey::Shape::kMark});
  for (int kind = 0; kind < kernels::kContourKinds; ++kind)
    if (options.contours[kind])
      legend.keys.push_back({kContourTexts[kind], kContourColours[kind], LegendKey::Shape::kLine});
  return legend;
}

/// Replaces values without a valid patch by NaN, and returns whether there are any.
bool mark_invalid(std::vector<ShownLevel>& levels) {
  bool found = false;
  for (ShownLevel& level : levels)
    for (std::size_t v = 0; v < level.values.size(); ++v)
      if (!(level.completeness[v] > 0)) {
        level.values[v] = std::numeric_limits<float>::quiet_NaN();
        found = true;
      }
  return found;
}

std::string caption_of(const io::Dataset& dataset, int level) {
  const std::string& unit = dataset.header().length_unit;
  return "level " + std::to_string(level) + ", \u03c3 = " + legend_number(dataset.scale(level)) +
         (unit == "unknown" ? "" : " " + io::printable(unit));
}

}  // namespace

DatasetPicture picture_of(const io::Dataset& dataset, const PictureOptions& options) {
  std::vector<ShownLevel> levels;
  for (const int level : options.levels)
    levels.push_back(read_level(dataset, level, options.field));
  const float limit = limit_of(levels, options);

  Legend legend = legend_of(dataset, options, limit);
  if (mark_invalid(levels))
    legend.keys.push_back({"no valid patch", kInvalidColour, LegendKey::Shape::kArea});
  std::vector<std::span<const float>> points;
  points.reserve(levels.size());
  for (const ShownLevel& level : levels) points.push_back(level.points);
  const LegendPainter painter(std::move(legend));
  const int panel_height = options.size - painter.caption_height();
  const Eigen::Matrix3f axes = axes_of(options.view, options.up);
  const int panel_width =
      static_cast<int>(static_cast<float>(panel_height) *
                       std::clamp(aspect_of(axes, points), kNarrowestPanel, kWidestPanel));
  const Camera camera = fitted_camera(axes, points, panel_width, panel_height);
  const float unit = static_cast<float>(options.size) / 1000;
  const RenderOptions render_options = {.width = panel_width,
                                        .height = panel_height,
                                        .scale = options.scale,
                                        .background = kWhite,
                                        .line_width = std::max(1.0f, 2.5f * unit),
                                        .mark_radius = std::max(1.5f, 6 * unit)};
  const auto panels = static_cast<int>(levels.size());
  DatasetPicture picture = {io::Image(panels * panel_width + painter.width(), options.size), limit};
  std::ranges::fill(picture.image.rgba, std::uint8_t{255});
  for (int i = 0; i < panels; ++i) {
    const ShownLevel& level = levels[i];
    const DrawnSurface surface = {level.points, level.normals, level.triangles, level.values,
                                  limit > 0 ? limit : 1.0f};
    const int number = options.levels[i];
    place(picture.image,
          render(surface, camera, render_options, lines_of(dataset, number, options),
                 marks_of(dataset, number, options)),
          i * panel_width, 0);
    painter.draw_caption(picture.image, i * panel_width, panel_width, caption_of(dataset, number));
  }
  painter.draw(picture.image, panels * panel_width);
  return picture;
}

}  // namespace semigeo::jobs
