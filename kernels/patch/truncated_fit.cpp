#include "kernels/patch/truncated_fit.hpp"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "kernels/patch/derivative_filters.hpp"
#include "kernels/patch/savitzky_golay.hpp"

namespace semigeo::kernels {
namespace {

constexpr double kMinQuadraticPivot = 2e-3;
constexpr double kMinQuarticPivot = 1e-8;
/// The sigma of the weights of the quartic, in steps. Less than a whole patch's: on the side
/// without samples the fit extrapolates, and far samples add more bias than they take noise.
constexpr double kRimSigma = 1.4;

/// Tells whether filters whose noise has this variance, in the worst second derivative, are of use.
bool quiet(double variance) {
  return variance <= kMaxNoiseGain * kMaxNoiseGain * savitzky_golay_filters().noise();
}

/// Holds sums of weighted powers along one axis of the lattice of a patch. Coordinates are in units
/// of sigma, and a sample k steps from the vertex has the weight exp(-sharpness (k / sigma)^2).
template <int powers>
struct AxisSums {
  using Row = std::array<double, powers>;
  std::array<Row, kTaps> sample;  ///< [k + kReach][p]: weight * (k / sigma)^p of one sample.
  /// [up][down][p]: the sum over samples -down ... up.
  std::array<std::array<Row, kReach + 1>, kReach + 1> range;

  AxisSums(double sigma, double sharpness) : sample{}, range{} {
    for (int k = -kReach; k <= kReach; ++k) {
      const double x = k / sigma;
      double power = std::exp(-sharpness * x * x);
      for (double& s : sample[k + kReach]) {
        s = power;
        power *= x;
      }
    }
    for (int up = 0; up <= kReach; ++up)
      for (int down = 0; down <= kReach; ++down)
        for (int k = -down; k <= up; ++k)
          for (int p = 0; p < powers; ++p) range[up][down][p] += sample[k + kReach][p];
  }
};

/// Fits polynomials of a degree to the samples of a patch, by least squares with Gaussian weights.
template <int degree>
class LatticeFit {
  static constexpr int kTerms = (degree + 1) * (degree + 2) / 2;

 public:
  /// Those rows of the inverse of the normal matrix that give r_u, r_v, r_uu, r_uv and r_vv.
  using Rows = Eigen::Matrix<double, kTerms, 5>;

  explicit LatticeFit(double sigma) : sigma_(sigma), sums_(sigma, 0.5), squared_sums_(sigma, 1) {}

  /// Solves the normal equations. Returns nothing if the samples do not determine the polynomial,
  /// or a pivot is below `min_pivot` of the largest.
  std::optional<Rows> solve(const Patch& patch, double min_pivot) const {
    int count = 0;
    for (int c = 0; c < kTaps; ++c)
      if (patch.reach_up[c] >= 0) count += patch.reach_up[c] + patch.reach_down[c] + 1;
    if (count < kTerms) return std::nullopt;
    const Eigen::LDLT<Matrix> ldlt(normal_matrix(patch, sums_));
    const auto pivots = ldlt.vectorD();
    if (ldlt.info() != Eigen::Success || !(pivots.minCoeff() > min_pivot * pivots.maxCoeff()))
      return std::nullopt;
    Rows rows = Rows::Zero();
    rows(1, 0) = rows(2, 1) = 1 / sigma_;
    rows(3, 2) = rows(5, 4) = 2 / (sigma_ * sigma_);
    rows(4, 3) = 1 / (sigma_ * sigma_);
    for (int k = 0; k < 5; ++k) rows.col(k) = ldlt.solve(rows.col(k)).eval();
    return rows;
  }

  /// Returns the variance of the worst second derivative, for samples with noise of variance 1.
  double noise(const Patch& patch, const Rows& rows) const {
    const Matrix squared = normal_matrix(patch, squared_sums_);
    double worst = 0;
    for (int k = 2; k < 5; ++k) {
      const Eigen::Matrix<double, kTerms, 1> row = rows.col(k);
      worst = std::max(worst, row.dot(squared.lazyProduct(row)));
    }
    return worst;
  }

  /// Returns the derivatives at the vertex; r is zero.
  PatchDerivatives derivatives(const Patch& patch, const Rows& rows, float step) const {
    Eigen::Matrix<double, 4, kTerms> right = Eigen::Matrix<double, 4, kTerms>::Zero();
    for (int c = 0; c < kTaps; ++c) {
      if (patch.reach_up[c] < 0) continue;
      Eigen::Matrix<double, 4, degree + 1> along = Eigen::Matrix<double, 4, degree + 1>::Zero();
      for (int r = kReach - patch.reach_down[c]; r <= kReach + patch.reach_up[c]; ++r) {
        const Eigen::Vector4d p = patch.sample[c][r].cast<double>();
        for (int q = 0; q <= degree; ++q) along.col(q) += sums_.sample[r][q] * p;
      }
      for (int d = 0, term = 0; d <= degree; ++d)
        for (int q = 0; q <= d; ++q, ++term)
          right.col(term) += sums_.sample[c][d - q] * along.col(q);
    }
    const Eigen::Matrix<double, 4, 5> d = right.lazyProduct(rows);
    const double s1 = 1 / static_cast<double>(step);
    const double s2 = s1 * s1;
    const auto column = [&](int k, double scale) {
      return Eigen::Vector3f((scale * d.col(k).template head<3>()).template cast<float>());
    };
    return {Eigen::Vector3f::Zero(), column(0, s1), column(1, s1),
            column(2, s2),           column(3, s2), column(4, s2)};
  }

 private:
  static constexpr int kPowers = 2 * degree + 1;
  using Matrix = Eigen::Matrix<double, kTerms, kTerms>;

  /// Returns the sum over all samples of weight * b b^T, where b has the
  /// monomials u^d, u^(d - 1) v, ..., v^d for d = 0, 1, ...
  static Matrix normal_matrix(const Patch& patch, const AxisSums<kPowers>& sums) {
    std::array<std::array<double, kPowers>, kPowers> moment{};  // [p][q]: of u^p v^q
    for (int c = 0; c < kTaps; ++c) {
      if (patch.reach_up[c] < 0) continue;
      const auto& along = sums.range[patch.reach_up[c]][patch.reach_down[c]];
      for (int p = 0; p < kPowers; ++p)
        for (int q = 0; q < kPowers - p; ++q) moment[p][q] += sums.sample[c][p] * along[q];
    }
    Matrix normal;
    for (int d = 0, i = 0; d <= degree; ++d)
      for (int q = 0; q <= d; ++q, ++i)
        for (int e = 0, j = 0; e <= degree; ++e)
          for (int r = 0; r <= e; ++r, ++j) normal(i, j) = moment[d - q + e - r][q + r];
    return normal;
  }

  double sigma_;
  AxisSums<kPowers> sums_;
  AxisSums<kPowers> squared_sums_;  ///< With the squares of the weights.
};

}  // namespace

std::optional<PatchDerivatives> fit_quadratic(const PatchSamples& samples, float step) {
  const auto filters = quadratic_filters(samples, 1, kMinQuadraticPivot);
  if (!filters) return std::nullopt;
  return apply(*filters, samples, step);
}

std::optional<PatchDerivatives> fit_quartic(const PatchSamples& samples, float step) {
  const auto filters = quartic_filters(samples, kRimSigma, kMinQuarticPivot);
  if (!filters) return std::nullopt;
  const double variance = filters->rightCols<3>().colwise().squaredNorm().maxCoeff();
  if (!quiet(variance)) return std::nullopt;
  return apply(*filters, samples, step);
}

std::optional<PatchDerivatives> fit_quadratic(const Patch& patch, float step) {
  static const LatticeFit<2> fit(1);
  const auto rows = fit.solve(patch, kMinQuadraticPivot);
  if (!rows) return std::nullopt;
  return fit.derivatives(patch, *rows, step);
}

std::optional<PatchDerivatives> fit_quartic(const Patch& patch, float step) {
  static const LatticeFit<4> fit(kRimSigma);
  const auto rows = fit.solve(patch, kMinQuarticPivot);
  if (!rows || !quiet(fit.noise(patch, *rows))) return std::nullopt;
  return fit.derivatives(patch, *rows, step);
}

}  // namespace semigeo::kernels
