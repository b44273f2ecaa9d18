#include "jobs/picture/renderer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;

constexpr float kNotValid = std::numeric_limits<float>::quiet_NaN();

/// Two squares that face the viewer: one fills the picture at depth 0, a smaller one is before it.
struct Squares {
  std::vector<float> points = {-8, -8, 0, 8, -8, 0, 8, 8, 0, -8, 8, 0,
                               -2, -2, 5, 2, -2, 5, 2, 2, 5, -2, 2, 5};
  std::vector<std::int64_t> triangles = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  std::vector<float> values = {-1, -1, -1, -1, 1, 1, 1, 1};

  DrawnSurface drawn() const { return {points, {}, triangles, values, 1}; }
};

/// Returns a camera for pictures of 20 x 20 pixels of one length unit.
Camera camera_from(View view) {
  Camera camera;
  camera.axes = axes_of(view, UpAxis::kY);
  return camera;
}

constexpr int kSize = 20;
const RenderOptions kOptions = {.width = kSize, .height = kSize};

std::array<int, 4> pixel(const io::Image& image, int x, int y) {
  const std::size_t at = image.at(x, y);
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2], image.rgba[at + 3]};
}

TEST(RendererTest, TheNearerSurfaceHidesTheOther) {
  const Squares squares;
  const io::Image image = render(squares.drawn(), camera_from(View::kFront), kOptions);
  const auto near = pixel(image, 10, 10);
  const auto far = pixel(image, 4, 10);
  EXPECT_GT(near[0], near[2]);  // the positive end is orange
  EXPECT_LT(far[0], far[2]);    // the negative end is blue
  EXPECT_EQ(pixel(image, 0, 0), (std::array{255, 255, 255, 255}));
  const io::Image behind = render(squares.drawn(), camera_from(View::kBack), kOptions);
  EXPECT_LT(pixel(behind, 10, 10)[0], pixel(behind, 10, 10)[2]);
}

TEST(RendererTest, TrianglesLeaveNoGapsBetweenThem) {
  const Squares squares;
  RenderOptions options = kOptions;
  options.transparent = true;
  const io::Image image = render(squares.drawn(), camera_from(View::kFront), options);
  for (int y = 2; y < 18; ++y)
    for (int x = 2; x < 18; ++x) EXPECT_EQ(pixel(image, x, y)[3], 255) << x << " " << y;
  EXPECT_EQ(pixel(image, 1, 10)[3], 0);
}

TEST(RendererTest, EdgesAreSmooth) {
  Squares squares;
  for (std::size_t i = 0; i < squares.points.size(); i += 3) squares.points[i] += 1.0f / 3;
  RenderOptions options = kOptions;
  options.transparent = true;
  const io::Image image = render(squares.drawn(), camera_from(View::kFront), options);
  EXPECT_EQ(pixel(image, 2, 10)[3], 170);  // two of three samples
  EXPECT_EQ(pixel(image, 18, 10)[3], 85);
}

TEST(RendererTest, InnerSidesAreDarker) {
  const Squares squares;
  const io::Image outer = render(squares.drawn(), camera_from(View::kFront), kOptions);
  const io::Image inner = render(squares.drawn(), camera_from(View::kBack), kOptions);
  EXPECT_LT(pixel(inner, 4, 10)[2], pixel(outer, 4, 10)[2]);
}

TEST(RendererTest, InvalidValuesAreGreyAndNoFieldIsPlain) {
  Squares squares;
  squares.values.assign(8, kNotValid);
  const auto grey = pixel(render(squares.drawn(), camera_from(View::kFront), kOptions), 10, 10);
  DrawnSurface surface = squares.drawn();
  surface.values = {};
  const auto plain = pixel(render(surface, camera_from(View::kFront), kOptions), 10, 10);
  EXPECT_NEAR(grey[0], grey[2], 12);
  EXPECT_GT(plain[0], grey[0] + 40);
}

TEST(RendererTest, GivenNormalsAreUsed) {
  const Squares squares;
  std::vector<float> normals;
  for (int v = 0; v < 8; ++v) normals.insert(normals.end(), {0.9f, -0.3f, 0.3f});
  DrawnSurface surface = squares.drawn();
  const auto facing = pixel(render(surface, camera_from(View::kFront), kOptions), 10, 10);
  surface.normals = normals;
  const auto turned = pixel(render(surface, camera_from(View::kFront), kOptions), 10, 10);
  EXPECT_LT(turned[0], facing[0] - 40);
}

TEST(RendererTest, LinesAndMarksAreHiddenBehindTheSurface) {
  const Squares squares;
  const Colour green = {0, 1, 0};
  const std::vector<DrawnLine> lines = {{{{-9, 0, 0}, {9, 0, 0}}, green}};
  const std::vector<DrawnMark> marks = {{{0, 6, 0}, green}, {{0, 0, -3}, green}};
  const io::Image image =
      render(squares.drawn(), camera_from(View::kFront), kOptions, lines, marks);
  EXPECT_EQ(pixel(image, 5, 10)[1], 255);
  EXPECT_NE(pixel(image, 10, 10)[1], 255);  // the near square is before line and mark
  EXPECT_EQ(pixel(image, 10, 4), (std::array{0, 255, 0, 255}));
}

TEST(RendererTest, ArraysThatDoNotFitAreRefused) {
  const Squares squares;
  const Camera camera = camera_from(View::kFront);
  DrawnSurface surface = squares.drawn();
  surface.values = surface.values.first(3);
  EXPECT_THROW(render(surface, camera, kOptions), std::invalid_argument);
  const std::vector<std::int64_t> outside = {0, 1, 8};
  surface = squares.drawn();
  surface.triangles = outside;
  EXPECT_THROW(render(surface, camera, kOptions), std::invalid_argument);
  EXPECT_THROW(render(squares.drawn(), camera, {.width = 0}), std::invalid_argument);
}

TEST(RendererTest, PointsThatAreNotFiniteAreNotSeen) {
  Squares squares;
  squares.points[0] = kNotValid;
  squares.points[5] = std::numeric_limits<float>::infinity();
  const io::Image image = render(squares.drawn(), camera_from(View::kFront), kOptions);
  EXPECT_GT(pixel(image, 10, 10)[0], pixel(image, 10, 10)[2]);
  EXPECT_EQ(pixel(image, 16, 16), (std::array{255, 255, 255, 255}));
}

}  // namespace
}  // namespace semigeo::jobs
