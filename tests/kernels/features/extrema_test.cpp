#include "kernels/features/extrema.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/prepared_surface.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::kernels {
namespace {

/// A sheet of 60 x 60 cells of size 0.1 about the origin, and values on it.
class Sheet {
 public:
  explicit Sheet(const std::function<double(double, double)>& value)
      : prepared_(shapes::plane(6, 60), false) {
    for (const auto& p : prepared_.points)
      values_.push_back(static_cast<float>(value(p.x(), p.y())));
    completeness.assign(values_.size(), 1.0f);
  }

  CurvatureField field() const {
    heights_ = heights_of(values_, completeness, 0.6f, 0);
    return {heights_};
  }
  Eigen::Vector2f at(std::int32_t v) const { return prepared_.points[v].head<2>(); }
  std::int32_t nearest(double x, double y) const {
    std::int32_t best = 0;
    const Eigen::Vector2f p(static_cast<float>(x), static_cast<float>(y));
    for (std::int32_t v = 0; v < prepared_.surface.vertex_count(); ++v)
      if ((at(v) - p).norm() < (at(best) - p).norm()) best = v;
    return best;
  }
  std::vector<std::int32_t> maxima(double radius) const {
    std::vector<std::int32_t> found;
    GeodesicBall ball;
    for (std::int32_t v = 0; v < prepared_.surface.vertex_count(); ++v)
      if (is_maximum(prepared_.surface, prepared_.points, field(), v, radius, ball))
        found.push_back(v);
    return found;
  }
  Eigen::Vector2f summit(std::int32_t v) const {
    const Summit point = kernels::summit(prepared_.surface, prepared_.points, field(), v);
    return point.of(prepared_.points).head<2>();
  }
  Eigen::Vector2f fitted_summit(std::int32_t v) const {
    const Summit point =
        kernels::fitted_summit(prepared_.surface, prepared_.points, field(), values_, v);
    return point.of(prepared_.points).head<2>();
  }
  std::vector<float> prominences() const {
    std::vector<std::int32_t> steps;
    for (std::int32_t v = 0; v < prepared_.surface.vertex_count(); ++v)
      steps.push_back(uphill(prepared_.surface, std::array{field()}, v)[0]);
    return kernels::prominences(prepared_.surface, field(), peaks_of(std::move(steps)));
  }

  std::vector<float> completeness;

 private:
  PreparedSurface prepared_;
  std::vector<float> values_;
  mutable std::vector<float> heights_;
};

double hill(double x, double y, double height, double width) {
  return height * std::exp(-(x * x + y * y) / (2 * width * width));
}

double two_hills(double x, double y) {
  return hill(x - 1, y, 1, 0.5) + hill(x + 1, y, 0.7, 0.5);
}

TEST(ExtremaTest, HillsAndHollowsAreFoundWhereTheyAre) {
  const Sheet sheet([](double x, double y) {
    return hill(x - 1.2, y, 1, 0.4) - hill(x + 1.2, y - 0.5, 0.5, 0.4);
  });
  const auto found = sheet.maxima(0.5);
  ASSERT_EQ(found.size(), 2);
  EXPECT_TRUE(std::ranges::count(found, sheet.nearest(1.2, 0)) == 1);
  EXPECT_TRUE(std::ranges::count(found, sheet.nearest(-1.2, 0.5)) == 1);
}

TEST(ExtremaTest, TheSummitLiesBetweenTheVertices) {
  for (const Eigen::Vector2d& top : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.03, 0.02),
                                     Eigen::Vector2d(-0.04, 0.03), Eigen::Vector2d(0.05, -0.05)}) {
    const Sheet sheet([&](double x, double y) { return hill(x - top.x(), y - top.y(), 1, 0.5); });
    const std::vector<std::int32_t> maxima = sheet.maxima(1);
    ASSERT_EQ(maxima.size(), 1);
    const Eigen::Vector2d vertex = sheet.at(maxima[0]).cast<double>();
    const Eigen::Vector2d found = sheet.summit(maxima[0]).cast<double>();
    EXPECT_LE((found - top).norm(), 0.55 * (vertex - top).norm() + 1e-6);
  }
}

TEST(ExtremaTest, OnAPlateauTheSummitIsTheVertex) {
  const Sheet sheet([](double, double) { return 2.0; });
  const std::int32_t middle = sheet.nearest(0, 0);
  EXPECT_EQ(sheet.summit(middle), sheet.at(middle));
}

// Hills as narrow as features are on levels whose edges are as long as the step.
TEST(ExtremaTest, TheFittedSummitOfANarrowHillIsItsTop) {
  for (const Eigen::Vector2d& top : {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.03, 0.02),
                                     Eigen::Vector2d(-0.04, 0.03), Eigen::Vector2d(0.05, -0.05)}) {
    const Sheet sheet([&](double x, double y) { return -hill(x - top.x(), y - top.y(), 1, 0.15); });
    const std::vector<std::int32_t> maxima = sheet.maxima(1);
    ASSERT_EQ(maxima.size(), 1);
    const Eigen::Vector2d found = sheet.fitted_summit(maxima[0]).cast<double>();
    EXPECT_LT((found - top).norm(), 0.01);  // a tenth of an edge
  }
}

TEST(ExtremaTest, AFitOfTooLittleIsTheSummit) {
  Sheet sheet([](double x, double y) { return 10 + x + 0.3 * y; });
  const std::int32_t corner = sheet.nearest(3, 3);
  EXPECT_EQ(sheet.fitted_summit(corner), sheet.summit(corner));
  sheet.completeness.assign(sheet.completeness.size(), 0);
  sheet.completeness[corner] = 1;
  EXPECT_EQ(sheet.fitted_summit(corner), sheet.at(corner));
  const Sheet flat([](double, double) { return 2.0; });
  const std::int32_t middle = flat.nearest(0, 0);
  EXPECT_EQ(flat.fitted_summit(middle), flat.at(middle));
}

/// Also where the ring is cut off by a boundary or by vertices that take no part.
TEST(ExtremaTest, TheSummitStaysOnItsFaces) {
  Sheet sheet([](double x, double y) { return 10 + x + 0.3 * y; });
  const std::int32_t corner = sheet.nearest(3, 3);
  EXPECT_LE(sheet.summit(corner).x(), 3);
  EXPECT_GT(sheet.summit(corner).x(), 2.9 - 1e-6);
  sheet.completeness.assign(sheet.completeness.size(), 0);
  sheet.completeness[corner] = 1;
  EXPECT_EQ(sheet.summit(corner), sheet.at(corner));
}

TEST(ExtremaTest, AHollowBesideAHillIsAMaximumOfItsOwn) {
  // The hollow's bottom has neighbours within the radius that are higher in magnitude.
  const Sheet sheet(
      [](double x, double y) { return hill(x - 0.4, y, 1, 0.2) - hill(x + 0.4, y, 0.3, 0.2); });
  const auto found = sheet.maxima(1.5);
  ASSERT_EQ(found.size(), 2);
}

TEST(ExtremaTest, ALargerRadiusLeavesTheHigherHill) {
  const Sheet sheet(two_hills);
  EXPECT_EQ(sheet.maxima(0).size(), 2);
  // The lower summit lies 1.58 from where the other hill is as high.
  EXPECT_EQ(sheet.maxima(1.4).size(), 2);
  const auto found = sheet.maxima(1.8);
  ASSERT_EQ(found.size(), 1);
  EXPECT_LT((sheet.at(found[0]) - Eigen::Vector2f(1, 0)).norm(), 0.08);
}

TEST(ExtremaTest, RadiusZeroIsTheRingOfNeighbours) {
  const Sheet ripples([](double x, double y) { return 2 + std::cos(12 * x) * std::cos(12 * y); });
  EXPECT_GT(ripples.maxima(0).size(), 100);
  EXPECT_LT(ripples.maxima(1).size(), 30);
}

TEST(ExtremaTest, OfAPlateauOneVertexIsAMaximum) {
  const Sheet sheet([](double, double) { return 1.0; });
  EXPECT_EQ(sheet.maxima(100).size(), 1);
  const Sheet nothing([](double, double) { return 0.0; });
  EXPECT_EQ(nothing.maxima(0).size(), 0);
}

TEST(ExtremaTest, TruncatedPatchesTakeNoPart) {
  Sheet sheet(two_hills);
  for (std::int32_t v = 0; v < 61 * 61; ++v)
    if (sheet.at(v).x() > 0.5f) sheet.completeness[v] = 0.59f;
  const auto found = sheet.maxima(3);
  ASSERT_EQ(found.size(), 1);
  EXPECT_LT((sheet.at(found[0]) - Eigen::Vector2f(-1, 0)).norm(), 0.08);
}

TEST(ExtremaTest, ProminenceIsTheFallToThePass) {
  const Sheet sheet(two_hills);
  const auto prominence = sheet.prominences();
  // The pass lies on the line between the summits.
  double pass = 1, summit = 0;
  for (double x = -1; x <= 1; x += 1e-3) {
    pass = std::min(pass, two_hills(x, 0));
    if (x < 0) summit = std::max(summit, two_hills(x, 0));
  }
  EXPECT_NEAR(prominence[sheet.nearest(-1, 0)], summit - pass, 0.02);
  EXPECT_NEAR(prominence[sheet.nearest(1, 0)], two_hills(1, 0), 1e-3);
  EXPECT_EQ(std::ranges::count_if(prominence, [](float p) { return p > 0; }), 2);
}

TEST(ExtremaTest, AHillBehindAHollowCannotBeReached) {
  const Sheet sheet([](double x, double) { return std::cos(x * 2); });
  const auto prominence = sheet.prominences();
  // Ridges at x = 0 and +-pi, hollows at +-pi / 2: each is an island of its own sign.
  int whole = 0;
  for (const float p : prominence) whole += p > 0.9f;
  EXPECT_EQ(whole, 5);
}

}  // namespace
}  // namespace semigeo::kernels
