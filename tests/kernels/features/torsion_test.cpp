#include "kernels/features/torsion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> curve(int count, double length,
                            const std::function<Vector3d(double)>& point) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) points.push_back(point(length * i / count));
  return points;
}

std::vector<Vector3d> at(const std::vector<Vector3d>& points, const ArcSamples& samples) {
  std::vector<Vector3d> result;
  for (const ArcPoint& p : samples.at)
    result.push_back(points[p.segment] +
                     p.fraction * (points[(p.segment + 1) % points.size()] - points[p.segment]));
  return result;
}

TEST(TorsionTest, EqualStepsAlongAPolyline) {
  const std::vector<Vector3d> bent = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 2, 0}};
  const ArcSamples open = resample(bent, false, 0.45);
  ASSERT_EQ(open.at.size(), 8);
  EXPECT_NEAR(open.spacing, 3.0 / 7, 1e-12);
  const auto points = at(bent, open);
  EXPECT_LT((points.front() - bent.front()).norm(), 1e-6);
  EXPECT_LT((points.back() - bent.back()).norm(), 1e-6);
  EXPECT_LT((points[3] - Vector3d(1, 2.0 / 7, 0)).norm(), 1e-6);

  const std::vector<Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const ArcSamples closed = resample(square, true, 0.26);
  ASSERT_EQ(closed.at.size(), 15);
  EXPECT_LT((at(square, closed).back() - Vector3d(0, 4.0 / 15, 0)).norm(), 1e-6);
  EXPECT_EQ(resample(square, true, 100).at.size(), 3);  // still goes round
  EXPECT_EQ(resample(std::vector<Vector3d>(3, Vector3d::Zero()), true, 1).at.size(), 1);
}

TEST(TorsionTest, TheThirdDerivativeIsExactUpToDegreeFour) {
  const auto& third = gaussian_filters().third;
  for (int degree = 0; degree <= 4; ++degree) {
    double sum = 0;
    for (int k = 0; k < kTaps; ++k) sum += third[k] * std::pow(k - kReach, degree);
    EXPECT_NEAR(sum, degree == 3 ? 6 : 0, 1e-5) << "degree " << degree;
  }
}

// c / (a^2 + c^2), both windings; the error is of second order in the step.
TEST(TorsionTest, OfAHelixIsConstant) {
  const double a = 1, c = 0.3;
  const double exact = c / (a * a + c * c);
  double previous = 0;
  for (const int count : {60, 120, 240}) {
    for (const double hand : {1.0, -1.0}) {
      const auto points = curve(count, 4 * std::numbers::pi, [&](double t) {
        return Vector3d(a * std::cos(t), a * std::sin(t), hand * c * t);
      });
      const auto tau = torsion(points, false);
      for (int i = 0; i < count; ++i) {
        const bool whole = i >= kReach && i + kReach < count;
        if (!whole) {
          EXPECT_EQ(tau[i], 0);
        } else {
          EXPECT_NEAR(tau[i], tau[count / 2], 1e-4);
        }
      }
      const double error = std::abs(hand * tau[count / 2] / exact - 1);
      EXPECT_LT(error, 0.12);
      if (previous > 0 && hand > 0) {
        EXPECT_NEAR(previous / error, 4, 0.7);
      }
      if (hand > 0) previous = error;
    }
  }
  EXPECT_LT(previous, 0.006);
}

TEST(TorsionTest, OfAPlaneCurveIsZero) {
  const auto points = curve(100, 2 * std::numbers::pi, [](double t) {
    const double r = 2 + 0.3 * std::cos(3 * t);
    return Vector3d(r * std::cos(t), 0.6 * r * std::sin(t), 0.8 * r * std::sin(t));
  });
  for (const float tau : torsion(points, true)) EXPECT_NEAR(tau, 0, 1e-5);
}

TEST(TorsionTest, OfAStraightLineIsZeroToo) {
  const auto points =
      curve(30, 3, [](double t) { return Vector3d(1e4 + t, 2 * t, -t + 1e-6 * std::sin(9 * t)); });
  for (const float tau : torsion(points, false)) EXPECT_EQ(tau, 0);
}

// Viviani: (1 + cos t, sin t, 2 sin(t / 2)), torsion 6 cos(t / 2) / (13 + 3 cos t).
TEST(TorsionTest, OfVivianisCurve) {
  const auto point = [](double t) {
    return Vector3d(1 + std::cos(t), std::sin(t), 2 * std::sin(t / 2));
  };
  const auto exact = [](double t) { return 6 * std::cos(t / 2) / (13 + 3 * std::cos(t)); };
  const auto dense = curve(20000, 4 * std::numbers::pi, point);
  for (const int count : {100, 400}) {
    const ArcSamples samples = resample(dense, true, length_of(dense, true) / count);
    ASSERT_EQ(static_cast<int>(samples.at.size()), count);
    const auto tau = torsion(at(dense, samples), true);
    double worst = 0;
    for (int i = 0; i < count; ++i) {
      const double t =
          (samples.at[i].segment + samples.at[i].fraction) * 4 * std::numbers::pi / 20000;
      worst = std::max(worst, std::abs(tau[i] - exact(t)));
    }
    EXPECT_LT(worst, count == 100 ? 0.08 : 0.006);
    // |torsion| is largest where the curve crosses itself, both times.
    EXPECT_GE(torsion_maxima(tau, true).size(), 2);
  }
}

TEST(TorsionTest, DoesNotDependOnPlaceSizeOrDirection) {
  const auto point = [](double t) {
    return Vector3d(std::cos(t), std::sin(t) + 0.2 * std::cos(2 * t), 0.4 * std::sin(2 * t));
  };
  const auto plain = curve(80, 2 * std::numbers::pi, point);
  auto moved = plain;
  for (auto& p : moved) p = 10 * p + Vector3d(1e5, -3e4, 7);
  const auto tau = torsion(plain, true);
  const auto tau_moved = torsion(moved, true);
  auto backwards = plain;
  std::ranges::reverse(backwards);
  const auto tau_backwards = torsion(backwards, true);
  for (int i = 0; i < 80; ++i) {
    EXPECT_NEAR(10 * tau_moved[i], tau[i], 1e-4);
    EXPECT_NEAR(tau_backwards[79 - i], tau[i], 1e-5);
  }
}

TEST(TorsionTest, MaximaAreOfTheMagnitude) {
  const std::vector<float> tau = {0, 1, 3, 2, -1, -4, -2, 0, 5};
  EXPECT_EQ(torsion_maxima(tau, false), (std::vector<std::int32_t>{2, 5}));
  EXPECT_EQ(torsion_maxima(tau, true), (std::vector<std::int32_t>{2, 5, 8}));
}

TEST(TorsionTest, ProminenceIsTheFallOnTheEasierWayToAHigherOne) {
  const std::vector<float> tau = {2, 1, -3, 0.5f, 4, 2, 5, 3, 3.5f};
  // 3 and 4 must climb down to 0.5 and 2 before they meet a higher one; on a closed contour 3.5 and
  // 2 are neighbours.
  EXPECT_EQ(torsion_prominences(tau, false), (std::vector<float>{1, 0, 2.5f, 0, 2, 0, 5, 0, 0.5f}));
  EXPECT_EQ(torsion_prominences(tau, true), (std::vector<float>{0, 0, 2, 0, 2, 0, 5, 0, 0.5f}));
  EXPECT_TRUE(torsion_prominences({}, true).empty());
}

/// Against the definition, on a walk of random steps.
TEST(TorsionTest, ProminenceAgreesWithItsDefinition) {
  std::mt19937 random(5);
  for (const bool closed : {false, true}) {
    std::vector<float> tau(40);
    for (float& t : tau) t = static_cast<float>(random() % 50) - 25;
    const auto found = torsion_prominences(tau, closed);
    const int n = static_cast<int>(tau.size());
    for (int i = 0; i < n; ++i) {
      float pass = -1;
      for (const int direction : {-1, 1}) {
        float lowest = std::abs(tau[i]);
        for (int k = 1; k < n; ++k) {
          int j = i + direction * k;
          if (!closed && (j < 0 || j >= n)) break;
          j = (j + n) % n;
          if (std::abs(tau[j]) > std::abs(tau[i])) {
            pass = std::max(pass, lowest);
            break;
          }
          lowest = std::min(lowest, std::abs(tau[j]));
        }
      }
      EXPECT_EQ(found[i], std::abs(tau[i]) - std::max(pass, 0.0f)) << i;
    }
  }
}

}  // namespace
}  // namespace semigeo::kernels
