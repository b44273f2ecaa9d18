#include "jobs/report/thumbnail.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/png.hpp"
#include "jobs/picture/camera.hpp"
#include "jobs/picture/renderer.hpp"
#include "jobs/picture/robust_limit.hpp"

namespace semigeo::jobs {
namespace {

/// Rounds colours, so that the picture takes less space. At this size nobody sees it.
void round_colours(io::Image& image) {
  constexpr int kStep = 16;
  for (std::uint8_t& value : image.rgba)
    value = static_cast<std::uint8_t>(std::min(255, (value + kStep / 2) / kStep * kStep));
}

}  // namespace

std::string thumbnail_of(const io::Dataset& dataset) {
  const auto level = (dataset.level_count() - 1) / 4;
  const std::vector<float> points = dataset.read_floats(level, "points");
  const std::vector<float> normals = dataset.read_floats(level, "normals");
  const std::vector<std::int64_t> triangles = dataset.read_integers(level, "triangles");
  const std::vector<float> completeness = dataset.read_floats(level, "patch_completeness");
  std::vector<float> values = dataset.read_floats(level, "mean_curvature");
  const std::array<FieldValues, 1> field = {{{values, completeness}}};
  const float limit = robust_limit(field);
  for (std::size_t v = 0; v < values.size(); ++v)
    if (!(completeness[v] > 0)) values[v] = std::numeric_limits<float>::quiet_NaN();
  const std::array<std::span<const float>, 1> surfaces = {points};
  const Camera camera =
      fitted_camera(axes_of(View::kIso, UpAxis::kY), surfaces, kThumbnailPixels, kThumbnailPixels);
  try {
    io::Image image = render(
        {.points = points,
         .normals = normals,
         .triangles = triangles,
         .values = values,
         .limit = limit > 0 ? limit : 1},
        camera, {.width = kThumbnailPixels, .height = kThumbnailPixels, .transparent = true});
    round_colours(image);
    return io::png_of(image);
  } catch (const std::invalid_argument& e) {
    throw io::Error(dataset.path(), io::level_path(level), e.what(), "make the dataset again");
  }
}

}  // namespace semigeo::jobs
