#include "kernels/recognition/slippage.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/random_similarity.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Vector3d round(double u) {
  return {std::cos(kTurn * u), std::sin(kTurn * u), 0};
}

Vector3d up(double height) {
  return {0, 0, height};
}

/// A surface by its parameters u and v in [0, 1), moved.
template <typename PointAt, typename NormalAt>
std::vector<OrientedPoint> surface_of(const PointAt& point_at, const NormalAt& normal_at,
                                      const Similarity& pose = {}) {
  constexpr int kSide = 40;
  std::vector<OrientedPoint> surface;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double u = (i % kSide + 0.5) / kSide;
    const double v = (i / kSide + 0.5) / kSide;
    const Vector3d point = point_at(u, v);
    const Vector3d normal = normal_at(u, v);
    surface.push_back(
        {pose.apply(point).cast<float>(), (pose.rotation * normal.normalized()).cast<float>()});
  }
  return surface;
}

std::vector<OrientedPoint> torus(const Similarity& pose) {
  const auto across = [](double u, double v) -> Vector3d {
    return std::cos(kTurn * v) * round(u) + up(std::sin(kTurn * v));
  };
  return surface_of([&](double u, double v) -> Vector3d { return round(u) + 0.4 * across(u, v); },
                    across, pose);
}

TEST(Slippage, WhatSlipsInTwoWaysIsNotHeld) {
  std::mt19937_64 random(1);
  const Similarity pose = random_similarity(random);
  const auto stability = [&](const auto& point_at, const auto& normal_at) {
    return Slippage(surface_of(point_at, normal_at, pose)).stability(0);
  };
  const auto outwards = [](double u, double) { return round(u); };
  const auto ball = [](double u, double v) -> Vector3d {
    return std::sqrt(1 - v * v) * round(u) + up(v);
  };
  EXPECT_LT(stability([](double u, double v) { return Vector3d(u, v, 0); },
                      [](double, double) { return up(1); }),
            1e-6)
      << "plane";
  EXPECT_LT(
      stability([](double u, double v) -> Vector3d { return round(u) + up(3 * v); }, outwards),
      1e-6)
      << "cylinder";
  EXPECT_LT(stability([](double u, double v) -> Vector3d { return (1 + v) * round(u) + up(v); },
                      [](double u, double) -> Vector3d { return round(u) - up(1); }),
            1e-6)
      << "cone";
  EXPECT_LT(stability(ball, ball), 1e-6) << "sphere";
  EXPECT_EQ(Slippage({}).stability(0), 0);
}

/// Samples of a closed rod along the z axis, evenly spread. `outline(u)` is a point of its outline
/// and the normal there, for u in [0, 1).
template <typename Outline>
std::vector<OrientedPoint> rod(double length, double end_share, const Outline& outline) {
  std::vector<OrientedPoint> samples;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 20'000; ++i) {
    const auto [point, normal] = outline(share(random));
    if (share(random) >= end_share) {
      samples.push_back({(point + up(length * share(random))).template cast<float>(),
                         normal.template cast<float>()});
    } else {
      const bool top = share(random) < 0.5;
      const Vector3d inside = std::sqrt(share(random)) * point;
      samples.push_back(
          {(inside + up(top ? length : 0)).template cast<float>(), up(top ? 1 : -1).cast<float>()});
    }
  }
  return samples;
}

// A thin rod is shifted along itself, where only its ends leave their planes, and grows, where
// nearly all ways lead along it too: those of the ends have 3 times the mean square. If it is
// round, it also turns about its axis. A square one moves its sides out of their planes then,
// however thin it is.
TEST(Slippage, ThinRodsAreHeldUnlessTheyAreRound) {
  struct Oriented {
    Vector3d point;
    Vector3d normal;
  };
  const auto circle = [](double u) { return Oriented{round(u), round(u)}; };
  const auto square = [](double u) {
    const double side = std::floor(4 * u);
    const Vector3d normal = round(side / 4);
    return Oriented{normal + (2 * (4 * u - side) - 1) * round((side + 1) / 4), normal};
  };
  const double ends = 1 / 41.0;  // the share of the surface, as of a rod of 20 widths
  for (const double thin : {1.0, 0.1}) {
    const auto thinner = [&](const auto& outline) {
      return [&, thin](double u) {
        Oriented o = outline(u);
        o.point *= thin;
        return o;
      };
    };
    EXPECT_NEAR(Slippage(rod(40, ends, thinner(circle))).stability(0), ends, 0.1 * ends);
    EXPECT_NEAR(Slippage(rod(40, ends, thinner(square))).stability(0), 3 * ends, 0.2 * ends);
  }
  // Nobody can tell ways that are much shorter than the tolerance.
  EXPECT_LT(Slippage(rod(40, ends, square)).stability(20), 0.01);
}

TEST(Slippage, StabilityHasNoUnit) {
  std::mt19937_64 random(2);
  const double here = Slippage(torus({})).stability(0);
  EXPECT_GT(here, 0.05);
  for (int trial = 0; trial < 5; ++trial)
    EXPECT_NEAR(Slippage(torus(random_similarity(random))).stability(0), here, 1e-4);
}

// A torus may turn about its axis, wherever that is, and in no other way.
TEST(Slippage, FreeTurnIsAboutTheAxis) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const Similarity pose = random_similarity(random);
    const std::optional<Axis> axis = Slippage(torus(pose)).free_rotation(0.001);
    ASSERT_TRUE(axis.has_value());
    EXPECT_GT(std::abs(axis->direction.dot(pose.rotation.col(2))), 0.9999);
    const Vector3d aside = axis->point - pose.translation;
    EXPECT_LT((aside - axis->direction * axis->direction.dot(aside)).norm(), 0.01 * pose.scale);
  }
}

// A part of it, the middle of which lies beside the axis.
TEST(Slippage, FreeTurnOfAPartIsAboutTheSameAxis) {
  const auto across = [](double u, double v) -> Vector3d {
    return std::cos(kTurn * v) * round(u / 4) + up(std::sin(kTurn * v));
  };
  const auto quarter = surface_of(
      [&](double u, double v) -> Vector3d { return round(u / 4) + 0.4 * across(u, v); }, across);
  const std::optional<Axis> axis = Slippage(quarter).free_rotation(0.001);
  ASSERT_TRUE(axis.has_value());
  EXPECT_GT(std::abs(axis->direction.z()), 0.9999);
  EXPECT_LT(axis->point.head<2>().norm(), 0.01);
}

/// Samples of three faces of a box that meet in a corner.
std::vector<OrientedPoint> faces_of_a_box(const Similarity& pose) {
  std::vector<OrientedPoint> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const auto face = surface_of(
        [&](double u, double v) {
          Vector3d point = Vector3d::Zero();
          point[(axis + 1) % 3] = u;
          point[(axis + 2) % 3] = 2 * v;
          return point;
        },
        [&](double, double) -> Vector3d { return Vector3d::Unit(axis); }, pose);
    faces.insert(faces.end(), face.begin(), face.end());
  }
  return faces;
}

TEST(Slippage, ThreeFacesOfABoxGrowAboutTheirCorner) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 5; ++trial) {
    const Similarity pose = random_similarity(random);
    const auto faces = faces_of_a_box(pose);
    const auto growth = Slippage(faces).free_scaling(1e-4);
    ASSERT_TRUE(growth);
    const Vector3d corner = pose.translation;
    for (const double log_scale : {-0.3, 0.2}) {
      const Similarity motion = growth->scaled(log_scale);
      EXPECT_NEAR(motion.scale, std::exp(log_scale), 1e-12);
      EXPECT_LT((motion.apply(corner) - corner).norm(), 1e-4 * pose.scale);
      for (const OrientedPoint& p : faces) {
        const Vector3d point = p.point.cast<double>();
        EXPECT_LT(std::abs((motion.apply(point) - point).dot(p.normal.cast<double>())),
                  1e-4 * pose.scale);
      }
    }
  }
}

TEST(Slippage, WhatHasASizeDoesNotGrow) {
  std::mt19937_64 random(4);
  const Similarity pose = random_similarity(random);
  EXPECT_FALSE(Slippage(torus(pose)).free_scaling(0.03));
  const auto ball = [](double u, double v) -> Vector3d {
    return std::sqrt(1 - v * v) * round(u) + up(v);
  };
  EXPECT_FALSE(Slippage(surface_of(ball, ball, pose)).free_scaling(0.03));
  // A cylinder can turn and shift, but not grow.
  const auto tube = surface_of([](double u, double v) -> Vector3d { return round(u) + up(v); },
                               [](double u, double) { return round(u); }, pose);
  EXPECT_FALSE(Slippage(tube).free_scaling(0.03));
}

TEST(Slippage, NothingTurnsThatIsHeldOrShifts) {
  // Three bars along the axes: nothing moves.
  std::vector<OrientedPoint> held;
  for (int axis = 0; axis < 3; ++axis)
    for (const OrientedPoint& p : torus({})) {
      Eigen::Vector3f point = p.point;
      Eigen::Vector3f normal = p.normal;
      for (int i = 0; i < 3; ++i) {
        point[(i + axis) % 3] = p.point[i] + (i == axis ? 1.0F : 0.0F);
        normal[(i + axis) % 3] = p.normal[i];
      }
      held.push_back({point, normal});
    }
  EXPECT_FALSE(Slippage(held).free_rotation(0.001).has_value());
  // A gutter with waves across: it can only be shifted along.
  const auto gutter = surface_of(
      [](double u, double v) { return Vector3d(4 * u, v, 0.2 * std::sin(2 * kTurn * v)); },
      [](double, double v) { return Vector3d(0, -0.4 * kTurn * std::cos(2 * kTurn * v), 1); });
  EXPECT_FALSE(Slippage(gutter).free_rotation(1).has_value());
}

}  // namespace
}  // namespace semigeo::kernels
