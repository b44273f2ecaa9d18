#include "kernels/features/zero_crossings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "kernels/features/torsion.hpp"
#include "kernels/surface/circulators.hpp"
#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;

struct Traced {
  PreparedSurface prepared;
  std::vector<float> values;
  std::vector<float> completeness;
  Contours contours;

  Traced(
      const TriangleMesh& mesh, const std::function<double(const Vector3d&)>& value,
      const std::function<bool(const Vector3d&)>& invalid = [](const Vector3d&) { return false; })
      : prepared(mesh, false) {
    for (const auto& p : prepared.points) {
      const Vector3d q = p.head<3>().cast<double>();
      values.push_back(static_cast<float>(value(q)));
      completeness.push_back(invalid(q) ? 0.0f : 1.0f);
    }
    const std::vector<float> heights = heights_of(values, completeness, 0.6f, 0);
    const CurvatureField field{heights};
    std::vector<std::int32_t> faces;
    find_crossing_faces(prepared.surface, field, 0,
                        static_cast<std::int32_t>(prepared.surface.face_count()), faces);
    contours = trace_contours(prepared.surface, field, faces);
  }

  std::vector<Vector3d> line(std::int64_t contour) const {
    std::vector<Vector3d> points;
    for (auto i = contours.offsets[contour]; i < contours.offsets[contour + 1]; ++i) {
      const EdgePoint& p = contours.points[i];
      points.push_back(p.between(prepared.points[p.positive], prepared.points[p.negative])
                           .head<3>()
                           .cast<double>());
    }
    return points;
  }
  double length(std::int64_t contour) const {
    return length_of(line(contour), contours.closed[contour] != 0);
  }
};

TEST(ZeroCrossingsTest, ACircleIsOneClosedContour) {
  const Traced t(shapes::plane(2, 40), [](const Vector3d& p) { return 0.49 - p.squaredNorm(); });
  ASSERT_EQ(t.contours.count(), 1);
  EXPECT_EQ(t.contours.closed[0], 1);
  EXPECT_NEAR(t.length(0), 2 * std::numbers::pi * 0.7, 0.005);
  double turned = 0;
  const auto line = t.line(0);
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i].norm(), 0.7, 1.5e-3);
    const Vector3d next = line[(i + 1) % line.size()];
    EXPECT_LT((next - line[i]).norm(), 0.08);
    turned += line[i].cross(next).z() / 0.49;
  }
  EXPECT_NEAR(turned, 2 * std::numbers::pi, 0.05);  // positive inside: on the left
}

TEST(ZeroCrossingsTest, AnOpenContourEndsAtTheBoundary) {
  const Traced t(shapes::plane(2, 20), [](const Vector3d& p) { return 0.317 - p.x(); });
  ASSERT_EQ(t.contours.count(), 1);
  EXPECT_EQ(t.contours.closed[0], 0);
  EXPECT_NEAR(t.length(0), 2, 1e-5);
  const auto line = t.line(0);
  EXPECT_NEAR(line.front().y(), -1, 1e-6);  // positive to the left of the way up
  EXPECT_NEAR(line.back().y(), 1, 1e-6);
  for (const auto& p : line) EXPECT_NEAR(p.x(), 0.317, 1e-6);
}

TEST(ZeroCrossingsTest, ThroughVerticesThatAreExactlyZero) {
  // The line runs along a column of vertices.
  const Traced t(shapes::plane(2, 20), [](const Vector3d& p) { return std::round(p.x() * 10); });
  ASSERT_EQ(t.contours.count(), 1);
  EXPECT_NEAR(t.length(0), 2, 1e-6);
  const auto line = t.line(0);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) EXPECT_GT((line[i + 1] - line[i]).norm(), 0.01);
  // Diagonally, through vertices and edges.
  const Traced d(shapes::plane(2, 20),
                 [](const Vector3d& p) { return std::round(10 * p.x()) - std::round(10 * p.y()); });
  ASSERT_EQ(d.contours.count(), 1);
  EXPECT_NEAR(d.length(0), std::sqrt(8.0), 1e-5);
}

TEST(ZeroCrossingsTest, AVertexThatJustTouchesZeroMakesNoContour) {
  const Traced t(shapes::plane(2, 20),
                 [](const Vector3d& p) { return p.norm() < 1e-6 ? 0.0 : -1.0; });
  EXPECT_EQ(t.contours.count(), 0);
  const Traced flat(shapes::plane(2, 20), [](const Vector3d&) { return 0.0; });
  EXPECT_EQ(flat.contours.count(), 0);
}

TEST(ZeroCrossingsTest, ContoursEndWhereCurvatureIsNotValid) {
  const Traced t(
      shapes::plane(2, 40), [](const Vector3d& p) { return 0.49 - p.squaredNorm(); },
      [](const Vector3d& p) { return std::abs(p.y()) < 0.07; });
  ASSERT_EQ(t.contours.count(), 2);
  EXPECT_EQ(t.contours.closed[0], 0);
  EXPECT_EQ(t.contours.closed[1], 0);
  for (const auto& p : t.line(0)) EXPECT_GE(std::abs(p.y()), 0.07 - 0.05);
}

// K = cos v / (r (R + r cos v)) vanishes on the top and the bottom circle.
TEST(ZeroCrossingsTest, KOfATorusVanishesOnTwoCircles) {
  const Traced t(shapes::torus(1, 0.4, 120, 60, 0.4), [](const Vector3d& p) {
    const double rho = std::hypot(p.x(), p.y());
    return (rho - 1) / 0.4 / (0.4 * rho);
  });
  ASSERT_EQ(t.contours.count(), 2);
  for (int c = 0; c < 2; ++c) {
    EXPECT_EQ(t.contours.closed[c], 1);
    EXPECT_NEAR(t.length(c), 2 * std::numbers::pi, 0.01 * 2 * std::numbers::pi);
    for (const auto& p : t.line(c)) EXPECT_NEAR(std::abs(p.z()), 0.4, 0.01);
  }
}

TEST(ZeroCrossingsTest, ManyContoursComeOnceEach) {
  const Traced t(shapes::icosphere(5), [](const Vector3d& p) {
    return std::sin(9 * p.x()) * std::sin(9 * p.y()) * std::sin(9 * p.z()) + 0.2;
  });
  EXPECT_GT(t.contours.count(), 10);
  std::vector<int> uses(t.contours.points.size(), 0);
  for (std::int64_t c = 0; c < t.contours.count(); ++c) EXPECT_EQ(t.contours.closed[c], 1);
  // Every crossed edge of the closed surface is in exactly one contour.
  std::size_t crossed = 0;
  const Surface& s = t.prepared.surface;
  for (const std::int32_t h : edges(s))
    crossed += (t.values[s.origin(h)] >= 0) != (t.values[s.target(h)] >= 0);
  EXPECT_EQ(t.contours.points.size(), crossed);
}

}  // namespace
}  // namespace semigeo::kernels
