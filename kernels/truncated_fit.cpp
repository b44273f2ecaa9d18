#include "kernels/truncated_fit.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "kernels/savitzky_golay.hpp"

namespace semigeo::kernels {
namespace {

/// Sigma of the weights of the quartic, in steps. Less than a whole patch's: on the side without
/// samples the fit extrapolates, and far samples add more bias than they take noise.
constexpr double kRimSigma = 1.4;
/// Smallest pivot, relative to the whole patch's, that a quadratic may have.
constexpr double kMinQuadraticPivot = 2e-3;
/// Smallest pivot, relative to the largest, below which a quartic is singular.
constexpr double kMinQuarticPivot = 1e-8;

constexpr int kDegree = 4;
constexpr int kTerms = (kDegree + 1) * (kDegree + 2) / 2;
constexpr int kMoments = 2 * kDegree + 1;

/// Monomials u^i v^j of up to degree 4, by degree: 1, u, v, uu, uv, vv, ...
struct Exponents {
  int u, v;
};
constexpr std::array<Exponents, kTerms> kMonomials = {{{0, 0},
                                                       {1, 0},
                                                       {0, 1},
                                                       {2, 0},
                                                       {1, 1},
                                                       {0, 2},
                                                       {3, 0},
                                                       {2, 1},
                                                       {1, 2},
                                                       {0, 3},
                                                       {4, 0},
                                                       {3, 1},
                                                       {2, 2},
                                                       {1, 3},
                                                       {0, 4}}};

using Powers = std::array<double, kMoments>;
using NormalMatrix = Eigen::Matrix<double, kTerms, kTerms>;

/// x^p for p up to 8, times a weight.
Powers weighted_powers(double weight, double x) {
  Powers powers{};
  for (int p = 0; p < kMoments; ++p, weight *= x) powers[p] = weight;
  return powers;
}

/// Per coordinate: the powers of u / sigma times the weight, and times its square.
struct TapPowers {
  std::array<Powers, kTaps> weighted;
  std::array<Powers, kTaps> weighted_twice;
};

const TapPowers& tap_powers() {
  static const TapPowers powers = [] {
    TapPowers p{};
    for (int k = 0; k < kTaps; ++k) {
      const double x = (k - kReach) / kRimSigma;
      const double weight = std::exp(-x * x / 2);
      p.weighted[k] = weighted_powers(weight, x);
      p.weighted_twice[k] = weighted_powers(weight * weight, x);
    }
    return p;
  }();
  return powers;
}

/// Sums over the existing samples of weight * u^a v^b, arranged as a matrix over the monomials.
NormalMatrix moment_matrix(const Patch& patch, const std::array<Powers, kTaps>& powers) {
  std::array<Powers, kMoments> moments{};  // [a][b]
  for (int c = 0; c < kTaps; ++c) {
    Powers column{};
    for (int k = 0; k < kTaps; ++k)
      if (patch.has(c, k))
        for (int b = 0; b < kMoments; ++b) column[b] += powers[k][b];
    for (int a = 0; a < kMoments; ++a)
      for (int b = 0; a + b < kMoments; ++b) moments[a][b] += powers[c][a] * column[b];
  }
  NormalMatrix matrix;
  for (int i = 0; i < kTerms; ++i)
    for (int j = 0; j < kTerms; ++j)
      matrix(i, j) = moments[kMonomials[i].u + kMonomials[j].u][kMonomials[i].v + kMonomials[j].v];
  return matrix;
}

Eigen::Matrix<double, kTerms, 3> right_side(const Patch& patch) {
  const auto& powers = tap_powers().weighted;
  Eigen::Matrix<double, kTerms, 3> right = Eigen::Matrix<double, kTerms, 3>::Zero();
  for (int c = 0; c < kTaps; ++c) {
    std::array<Eigen::Vector3d, kDegree + 1> column;
    column.fill(Eigen::Vector3d::Zero());
    for (int k = 0; k < kTaps; ++k) {
      if (!patch.has(c, k)) continue;
      const Eigen::Vector3d p = patch.sample[c][k].head<3>().cast<double>();
      for (int b = 0; b <= kDegree; ++b) column[b] += powers[k][b] * p;
    }
    for (int i = 0; i < kTerms; ++i)
      right.row(i) += powers[c][kMonomials[i].u] * column[kMonomials[i].v].transpose();
  }
  return right;
}

double squared_norm(const std::array<float, kTaps>& filter) {
  double sum = 0;
  for (const float tap : filter) sum += static_cast<double>(tap) * tap;
  return sum;
}

/// Variance of a whole patch's r_uu for unit noise of the samples and unit step.
double whole_variance() {
  static const double variance =
      squared_norm(savitzky_golay_filters().second) * squared_norm(savitzky_golay_filters().value);
  return variance;
}

/// 1, u, v, u^2/2, u v, v^2/2: the coefficients are the derivatives themselves.
Eigen::Matrix<double, 6, 1> quadratic_basis(double u, double v) {
  Eigen::Matrix<double, 6, 1> b;
  b << 1, u, v, u * u / 2, u * v, v * v / 2;
  return b;
}

}  // namespace

std::optional<PatchDerivatives> fit_quadratic(const Patch& patch, float step) {
  const auto& g = gaussian_filters().smooth;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 3> right = Eigen::Matrix<double, 6, 3>::Zero();
  for (int c = 0; c < kTaps; ++c)
    for (int k = 0; k < kTaps; ++k) {
      if (!patch.has(c, k)) continue;
      const auto b = quadratic_basis(c - kReach, k - kReach);
      const double weight = static_cast<double>(g[c]) * g[k];
      normal.noalias() += weight * b * b.transpose();
      right.noalias() += weight * b * patch.sample[c][k].head<3>().cast<double>().transpose();
    }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> ldlt(normal);
  const bool determined =
      ldlt.info() == Eigen::Success && ldlt.vectorD().minCoeff() > kMinQuadraticPivot;
  if (!determined) return std::nullopt;
  const Eigen::Matrix<float, 6, 3> x = ldlt.solve(right).cast<float>();
  const float s1 = 1 / step;
  const float s2 = s1 * s1;
  return PatchDerivatives{x.row(0),      x.row(1) * s1, x.row(2) * s1,
                          x.row(3) * s2, x.row(4) * s2, x.row(5) * s2};
}

std::optional<PatchDerivatives> fit_quartic(const Patch& patch, float step) {
  const Eigen::LDLT<NormalMatrix> ldlt(moment_matrix(patch, tap_powers().weighted));
  const auto pivots = ldlt.vectorD();
  if (ldlt.info() != Eigen::Success || !(pivots.minCoeff() > kMinQuarticPivot * pivots.maxCoeff()))
    return std::nullopt;

  // Row i of the inverse is the filter of coefficient i, over weight * monomials: its variance.
  Eigen::Matrix<double, kTerms, 3> inverse = Eigen::Matrix<double, kTerms, 3>::Zero();
  for (int d = 0; d < 3; ++d) inverse(3 + d, d) = 1;
  inverse = ldlt.solve(inverse).eval();
  const NormalMatrix noise = moment_matrix(patch, tap_powers().weighted_twice);
  const double unit = 1 / (kRimSigma * kRimSigma);  // monomials are in u / sigma
  const Eigen::Vector3d factor(2 * unit, unit, 2 * unit);
  for (int d = 0; d < 3; ++d) {
    const double variance = factor[d] * factor[d] * inverse.col(d).dot(noise * inverse.col(d));
    if (!(variance <= kMaxNoiseGain * kMaxNoiseGain * whole_variance())) return std::nullopt;
  }

  const Eigen::Matrix<double, kTerms, 3> x = ldlt.solve(right_side(patch));
  const auto row = [&](int i, double scale) {
    return Eigen::Vector3f((scale * x.row(i).transpose()).cast<float>());
  };
  const double s1 = 1 / (kRimSigma * step);
  const double s2 = s1 * s1;
  return PatchDerivatives{row(0, 1),      row(1, s1), row(2, s1),
                          row(3, 2 * s2), row(4, s2), row(5, 2 * s2)};
}

Eigen::Vector3f paired_mean(const Patch& patch) {
  const auto& g = gaussian_filters().smooth;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r)
      if (patch.has(c, r) && patch.has(kTaps - 1 - c, kTaps - 1 - r))
        sum += g[c] * g[r] * patch.sample[c][r];
  return sum.head<3>();
}

}  // namespace semigeo::kernels
