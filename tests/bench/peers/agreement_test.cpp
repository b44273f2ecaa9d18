#include "bench/peers/agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "kernels/repair/surface_builder.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::peers {
namespace {

View view_of(kernels::TriangleMesh mesh) {
  View view{kernels::build_surface(std::move(mesh)).surface, {}};
  view.trusted.assign(view.surface.points.size(), 1);
  return view;
}

/// Returns a function that is linear in space, at the vertices of a view.
std::vector<double> linear(const View& view) {
  std::vector<double> values;
  for (const Eigen::Vector3f& p : view.surface.points) values.push_back(3 + 2 * p.x() - p.y());
  return values;
}

Agreement compared(const std::vector<SamePlace>& places, const std::vector<double>& first,
                   const std::vector<double>& second) {
  Comparison comparison;
  comparison.add(places, first, second);
  return comparison.agreement();
}

TEST(Agreement, ValuesAreInterpolatedOnTheOtherView) {
  const View first = view_of(shapes::plane(2, 10)), second = view_of(shapes::plane(2, 7));
  const auto places = same_places(first, second, 0.1);
  EXPECT_EQ(places.size(), first.surface.points.size());
  const Agreement agreement = compared(places, linear(first), linear(second));
  EXPECT_EQ(agreement.places, static_cast<std::int64_t>(places.size()));
  EXPECT_NEAR(agreement.rms_difference, 0, 1e-6);
  EXPECT_NEAR(agreement.median_difference, 0, 1e-6);
}

TEST(Agreement, IsAShareOfTheValues) {
  const View view = view_of(shapes::plane(2, 4));
  const auto places = same_places(view, view, 0.1);
  std::vector<double> first(view.surface.points.size(), 3), second(first.size(), 4);
  const Agreement agreement = compared(places, first, second);
  EXPECT_DOUBLE_EQ(agreement.rms, std::sqrt((9 + 16) / 2.0));
  EXPECT_NEAR(agreement.rms_difference, 1 / std::sqrt(12.5), 1e-6);
  EXPECT_NEAR(agreement.median_difference, 0.25, 0.1);  // The median of threes and fours is one.
  // Neither sign nor unit matters.
  for (double& value : first) value *= -1000;
  for (double& value : second) value *= -1000;
  EXPECT_NEAR(compared(places, first, second).rms_difference, agreement.rms_difference, 1e-9);
}

TEST(Agreement, PlacesThatAreFarUntrustedOrOnTheOtherSideAreLeftOut) {
  const View view = view_of(shapes::plane(2, 4));
  View other = view;
  for (Eigen::Vector3f& p : other.surface.points) p.z() += 0.2f;
  EXPECT_TRUE(same_places(view, other, 0.1).empty());
  EXPECT_EQ(same_places(view, other, 0.3).size(), view.surface.points.size());

  View untrusted = view;
  untrusted.trusted[12] = 0;  // The middle, with its six or so faces.
  EXPECT_EQ(same_places(untrusted, view, 0.1).size(), view.surface.points.size() - 1);
  EXPECT_LT(same_places(view, untrusted, 0.1).size(), view.surface.points.size());

  kernels::TriangleMesh turned = shapes::plane(2, 4);
  for (auto& t : turned.triangles) std::swap(t[1], t[2]);
  EXPECT_TRUE(same_places(view, view_of(std::move(turned)), 0.1).empty());
}

TEST(Agreement, ValuesThatAreNotThereAreLeftOut) {
  const View view = view_of(shapes::plane(2, 4));
  const auto places = same_places(view, view, 0.1);
  std::vector<double> values = linear(view);
  const std::vector<double> whole = values;
  values[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compared(places, values, whole).places, static_cast<std::int64_t>(places.size()) - 1);
}

AgreementRow row_of(double size, double microseconds, double rms, double difference) {
  return {"jets", size, microseconds, {7, difference / 2, difference, rms}};
}

TEST(EqualDetail, LiesBetweenTheRowsThatEncloseIt) {
  const std::vector<AgreementRow> rows = {row_of(2, 10, 160, 0.8), row_of(4, 40, 40, 0.2),
                                          row_of(6, 90, 20, 0.1)};
  const AgreementRow middle = at_equal_detail(rows, 80);
  EXPECT_NEAR(middle.size, std::sqrt(8.0), 1e-12);
  EXPECT_NEAR(middle.microseconds, 20, 1e-12);
  EXPECT_NEAR(middle.agreement.rms_difference, 0.4, 1e-12);
  EXPECT_NEAR(middle.agreement.median_difference, 0.2, 1e-12);
  EXPECT_NEAR(at_equal_detail(rows, 40).microseconds, 40, 1e-9);
  EXPECT_NEAR(at_equal_detail(rows, 20).microseconds, 90, 1e-9);
}

TEST(EqualDetail, IsUnknownBeyondTheRows) {
  const std::vector<AgreementRow> rows = {row_of(2, 10, 160, 0.8), row_of(4, 40, 40, 0.2)};
  EXPECT_TRUE(std::isnan(at_equal_detail(rows, 161).size));
  EXPECT_TRUE(std::isnan(at_equal_detail(rows, 39).agreement.rms_difference));
  EXPECT_TRUE(std::isnan(at_equal_detail({}, 39).microseconds));
}

}  // namespace
}  // namespace semigeo::peers
