#include "jobs/picture/renderer.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace semigeo::jobs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

/// Samples of a pixel along each axis.
constexpr int kSamples = 3;
/// Rows of pixels that are drawn at a time.
constexpr int kBandRows = 64;
/// How far lines and marks stand out towards the viewer, as a part of the picture's larger side.
constexpr float kLift = 0.006f;

void check(const DrawnSurface& surface) {
  const std::size_t vertices = surface.points.size() / 3;
  bool fits = surface.points.size() % 3 == 0 && surface.triangles.size() % 3 == 0 &&
              (surface.normals.empty() || surface.normals.size() == surface.points.size()) &&
              (surface.values.empty() || surface.values.size() == vertices);
  for (const std::int64_t corner : surface.triangles)
    fits = fits && corner >= 0 && corner < static_cast<std::int64_t>(vertices);
  if (!fits) throw std::invalid_argument("render: arrays that do not fit each other");
}

Vector3f row_of(std::span<const float> rows, std::int64_t row) {
  return {rows[3 * row], rows[3 * row + 1], rows[3 * row + 2]};
}

/// Returns unit normals of the vertices: means of their triangles' normals by area.
std::vector<Vector3f> normals_of(const DrawnSurface& surface) {
  const std::size_t vertices = surface.points.size() / 3;
  std::vector<Vector3f> normals(vertices, Vector3f::Zero());
  if (surface.normals.empty()) {
    for (std::size_t t = 0; t < surface.triangles.size(); t += 3) {
      const Vector3f a = row_of(surface.points, surface.triangles[t]);
      const Vector3f b = row_of(surface.points, surface.triangles[t + 1]);
      const Vector3f c = row_of(surface.points, surface.triangles[t + 2]);
      const Vector3f normal = (b - a).cross(c - a);
      if (!normal.allFinite()) continue;
      for (std::size_t i = t; i < t + 3; ++i) normals[surface.triangles[i]] += normal;
    }
  } else {
    for (std::size_t v = 0; v < vertices; ++v)
      normals[v] = row_of(surface.normals, static_cast<std::int64_t>(v));
  }
  for (Vector3f& normal : normals) normal.normalize();
  return normals;
}

Colour scaled(const Colour& colour, float factor, float added) {
  Colour result = {};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = std::clamp(factor * colour[i] + added, 0.0f, 1.0f);
  return result;
}

/// Returns the light that the viewer sees of a surface of this colour. The normal is a unit vector
/// in the directions of the camera. One light stands at the upper left, one beside the viewer.
Colour shaded(const Colour& colour, Vector3f normal) {
  static const Vector3f kKey = Vector3f(-0.45f, 0.65f, 0.75f).normalized();
  static const Vector3f kGloss = (kKey + Vector3f(0, 0, 1)).normalized();
  const bool inner = normal.z() < 0;
  if (inner) normal = -normal;
  const float key = std::max(0.0f, normal.dot(kKey));
  const float gloss = inner ? 0.0f : 0.1f * std::pow(std::max(0.0f, normal.dot(kGloss)), 32.0f);
  // Bright also at the rims, so that white does not become the grey of invalid vertices.
  const float light = 0.50f + 0.30f * key + 0.25f * normal.z();
  return scaled(colour, inner ? 0.6f * light : light, gloss);
}

/// Draws one picture, a band of rows after the other.
class Renderer {
 public:
  Renderer(const DrawnSurface& surface, const Camera& camera, const RenderOptions& options)
      : surface_(surface), camera_(camera), options_(options), normals_(normals_of(surface)) {
    const std::size_t vertices = surface.points.size() / 3;
    places_.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v)
      places_.push_back(sample_place(row_of(surface.points, static_cast<std::int64_t>(v))));
    columns_ = kSamples * options.width;
    const auto samples = static_cast<std::size_t>(columns_) * kSamples * kBandRows;
    depth_.resize(samples);
    triangle_.resize(samples);
    colour_.resize(samples);
  }

  io::Image draw(std::span<const DrawnLine> lines, std::span<const DrawnMark> marks) {
    io::Image image(options_.width, options_.height);
    for (int row = 0; row < options_.height; row += kBandRows) {
      first_ = row * kSamples;
      rows_ = kSamples * std::min(kBandRows, options_.height - row);
      std::ranges::fill(depth_, -std::numeric_limits<float>::infinity());
      std::ranges::fill(triangle_, kNothing);
      for (std::size_t t = 0; t < surface_.triangles.size(); t += 3) cover(t);
      shade();
      for (const DrawnLine& line : lines) draw_line(line);
      for (const DrawnMark& mark : marks) draw_mark(mark);
      average(image, row);
    }
    return image;
  }

 private:
  static constexpr std::int64_t kNothing = -1;
  static constexpr std::int64_t kDrawn = -2;  ///< The sample has the colour of a line or mark.

  /// Returns the place of a point in samples, from the upper left corner.
  Vector3f sample_place(const Vector3f& point) const {
    const Vector3f middle(0.5f * static_cast<float>(options_.width),
                          0.5f * static_cast<float>(options_.height), 0);
    return kSamples * (camera_.place(point) + middle);
  }

  std::size_t sample_at(int x, int y) const {
    return static_cast<std::size_t>(y - first_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  /// Calls put(x, y) for each sample of the band in a box of places.
  template <typename Put>
  void for_samples(const Vector2f& low, const Vector2f& high, const Put& put) const {
    const auto bounded = [](float place, int least, int most) {
      return static_cast<int>(
          std::clamp(place, static_cast<float>(least), static_cast<float>(most)));
    };
    if (!(low.x() < static_cast<float>(columns_)) || !(high.x() >= 0)) return;
    if (!(low.y() < static_cast<float>(first_ + rows_)) ||
        !(high.y() >= static_cast<float>(first_)))
      return;
    const int right = bounded(high.x(), 0, columns_ - 1);
    const int bottom = bounded(high.y(), first_, first_ + rows_ - 1);
    for (int y = bounded(low.y(), first_, first_ + rows_ - 1); y <= bottom; ++y)
      for (int x = bounded(low.x(), 0, columns_ - 1); x <= right; ++x) put(x, y);
  }

  /// Returns the shares of the corners at a sample; one of them is negative beside the triangle.
  Vector3f shares_at(std::size_t first_corner, int x, int y) const {
    const Vector3f& a = places_[surface_.triangles[first_corner]];
    const Vector3f& b = places_[surface_.triangles[first_corner + 1]];
    const Vector3f& c = places_[surface_.triangles[first_corner + 2]];
    const double px = x + 0.5;
    const double py = y + 0.5;
    const auto cross = [](double ux, double uy, double vx, double vy) { return ux * vy - uy * vx; };
    const double area = cross(double{b.x()} - a.x(), double{b.y()} - a.y(), double{c.x()} - a.x(),
                              double{c.y()} - a.y());
    const double share_b =
        cross(px - a.x(), py - a.y(), double{c.x()} - a.x(), double{c.y()} - a.y()) / area;
    const double share_c =
        cross(double{b.x()} - a.x(), double{b.y()} - a.y(), px - a.x(), py - a.y()) / area;
    return {static_cast<float>(1 - share_b - share_c), static_cast<float>(share_b),
            static_cast<float>(share_c)};
  }

  /// Notes the triangle at each sample where it is the nearest so far.
  void cover(std::size_t first_corner) {
    const Vector3f& a = places_[surface_.triangles[first_corner]];
    const Vector3f& b = places_[surface_.triangles[first_corner + 1]];
    const Vector3f& c = places_[surface_.triangles[first_corner + 2]];
    const Vector2f low = a.head<2>().cwiseMin(b.head<2>()).cwiseMin(c.head<2>());
    const Vector2f high = a.head<2>().cwiseMax(b.head<2>()).cwiseMax(c.head<2>());
    for_samples(low, high, [&](int x, int y) {
      const Vector3f shares = shares_at(first_corner, x, y);
      // A little more than the triangle, so that rounding leaves no gap to its neighbours.
      if (!(shares.minCoeff() >= -1e-5f)) return;
      const float depth = shares.dot(Vector3f(a.z(), b.z(), c.z()));
      const std::size_t sample = sample_at(x, y);
      if (!(depth > depth_[sample])) return;
      depth_[sample] = depth;
      triangle_[sample] = static_cast<std::int64_t>(first_corner);
    });
  }

  Colour colour_at(std::size_t first_corner, const Vector3f& shares) const {
    Vector3f normal = Vector3f::Zero();
    float value = 0;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t corner = surface_.triangles[first_corner + static_cast<std::size_t>(i)];
      normal += shares[i] * normals_[corner];
      if (!surface_.values.empty()) value += shares[i] * surface_.values[corner];
    }
    const Colour colour =
        surface_.values.empty() ? kPlainColour : colour_of(options_.scale, value / surface_.limit);
    return shaded(colour, (camera_.axes * normal).normalized());
  }

  void shade() {
    for (int y = first_; y < first_ + rows_; ++y)
      for (int x = 0; x < columns_; ++x) {
        const std::size_t sample = sample_at(x, y);
        const std::int64_t corner = triangle_[sample];
        if (corner == kNothing) {
          colour_[sample] = options_.background;
        } else {
          const auto first_corner = static_cast<std::size_t>(corner);
          colour_[sample] = colour_at(first_corner, shares_at(first_corner, x, y));
        }
      }
  }

  float lift() const {
    return kLift * kSamples * static_cast<float>(std::max(options_.width, options_.height));
  }

  /// Gives the samples near a segment a colour, unless the surface hides them.
  void draw_segment(const Vector3f& from, const Vector3f& to, float radius, const Colour& colour) {
    const Vector2f along = to.head<2>() - from.head<2>();
    const float length = std::max(along.squaredNorm(), std::numeric_limits<float>::min());
    const Vector2f reach = Vector2f::Constant(radius);
    for_samples(from.head<2>().cwiseMin(to.head<2>()) - reach,
                from.head<2>().cwiseMax(to.head<2>()) + reach, [&](int x, int y) {
                  const Vector2f away =
                      Vector2f(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) -
                      from.head<2>();
                  const float share = std::clamp(away.dot(along) / length, 0.0f, 1.0f);
                  if (!((away - share * along).squaredNorm() <= radius * radius)) return;
                  const std::size_t sample = sample_at(x, y);
                  const float depth = from.z() + share * (to.z() - from.z()) + lift();
                  if (depth < depth_[sample]) return;
                  colour_[sample] = colour;
                  triangle_[sample] = kDrawn;
                });
  }

  void draw_line(const DrawnLine& line) {
    const float radius = 0.5f * kSamples * options_.line_width;
    for (std::size_t i = 1; i < line.points.size(); ++i)
      draw_segment(sample_place(line.points[i - 1]), sample_place(line.points[i]), radius,
                   line.colour);
  }

  /// Draws a disc with a dark rim.
  void draw_mark(const DrawnMark& mark) {
    const Vector3f place = sample_place(mark.point);
    const float radius = kSamples * options_.mark_radius;
    draw_segment(place, place, radius, Colour{0, 0, 0});
    draw_segment(place, place, 0.7f * radius, mark.colour);
  }

  /// Writes the pixels of the band: means of their samples.
  void average(io::Image& image, int first_row) const {
    for (int row = 0; row < rows_ / kSamples; ++row)
      for (int x = 0; x < options_.width; ++x) {
        Colour sum = {};
        int covered = 0;
        for (int i = 0; i < kSamples * kSamples; ++i) {
          const std::size_t sample =
              sample_at(x * kSamples + i % kSamples, first_ + row * kSamples + i / kSamples);
          if (options_.transparent && triangle_[sample] == kNothing) continue;
          ++covered;
          for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += colour_[sample][c];
        }
        if (covered == 0) continue;
        std::uint8_t* pixel = &image.rgba[image.at(x, first_row + row)];
        for (std::size_t c = 0; c < sum.size(); ++c)
          pixel[c] = channel_byte(sum[c] / static_cast<float>(covered));
        pixel[3] = static_cast<std::uint8_t>(255 * covered / (kSamples * kSamples));
      }
  }

  const DrawnSurface& surface_;
  const Camera& camera_;
  const RenderOptions& options_;
  std::vector<Vector3f> normals_;
  std::vector<Vector3f> places_;
  int columns_ = 0;                     ///< Samples of a row.
  int first_ = 0;                       ///< First row of samples of the band.
  int rows_ = 0;                        ///< Rows of samples of the band.
  std::vector<float> depth_;            ///< Samples towards the viewer; -infinity: nothing yet.
  std::vector<std::int64_t> triangle_;  ///< First corner of the nearest triangle.
  std::vector<Colour> colour_;
};

}  // namespace

io::Image render(const DrawnSurface& surface, const Camera& camera, const RenderOptions& options,
                 std::span<const DrawnLine> lines, std::span<const DrawnMark> marks) {
  check(surface);
  if (options.width <= 0 || options.height <= 0)
    throw std::invalid_argument("render: a picture without pixels");
  return Renderer(surface, camera, options).draw(lines, marks);
}

}  // namespace semigeo::jobs
