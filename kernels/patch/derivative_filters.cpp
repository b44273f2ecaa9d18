#include "kernels/patch/derivative_filters.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace semigeo::kernels {
namespace {

template <int degree>
constexpr int kTerms = (degree + 1) * (degree + 2) / 2;

template <int degree>
using Basis = Eigen::Matrix<double, kTerms<degree>, 1>;

/// Returns the monomials u^i v^j by degree: 1, u, v, uu, uv, vv, ...
template <int degree>
Basis<degree> monomials(double u, double v) {
  Basis<degree> b;
  b[0] = 1;
  for (int d = 1, at = 1, before = 0; d <= degree; before = at, at += d + 1, ++d) {
    for (int i = 0; i < d; ++i) b[at + i] = u * b[before + i];
    b[at + d] = v * b[at - 1];
  }
  return b;
}

template <int degree>
std::optional<DerivativeFilters> polynomial_filters(const PatchSamples& samples, double sigma,
                                                    double min_pivot) {
  constexpr int terms = kTerms<degree>;
  const auto count = static_cast<Eigen::Index>(samples.size());
  if (count < terms) return std::nullopt;
  Eigen::Matrix<double, Eigen::Dynamic, terms, Eigen::RowMajor, PatchSamples::kCapacity, terms>
      weighted(count, terms);
  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
  for (Eigen::Index i = 0; i < count; ++i) {
    const PatchSample& s = samples[static_cast<std::size_t>(i)];
    const double u = s.u / sigma;
    const double v = s.v / sigma;
    const Basis<degree> b = monomials<degree>(u, v);
    weighted.row(i) = s.area * std::exp(-(u * u + v * v) / 2) * b.transpose();
    normal.noalias() += b * weighted.row(i);
  }
  const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> ldlt(normal);
  const auto pivots = ldlt.vectorD();
  if (ldlt.info() != Eigen::Success || !(pivots.minCoeff() > min_pivot * pivots.maxCoeff()))
    return std::nullopt;
  // Coefficient k is row k of the inverse, times weighted^T, times the samples.
  const double s1 = 1 / sigma;
  const double s2 = s1 * s1;
  Eigen::Matrix<double, terms, 5> rows = Eigen::Matrix<double, terms, 5>::Zero();
  rows(1, 0) = rows(2, 1) = s1;
  rows(3, 2) = rows(5, 4) = 2 * s2;
  rows(4, 3) = s2;
  return DerivativeFilters(weighted * ldlt.solve(rows));
}

}  // namespace

std::optional<DerivativeFilters> quadratic_filters(const PatchSamples& samples, double sigma,
                                                   double min_pivot) {
  return polynomial_filters<2>(samples, sigma, min_pivot);
}

std::optional<DerivativeFilters> quartic_filters(const PatchSamples& samples, double sigma,
                                                 double min_pivot) {
  return polynomial_filters<4>(samples, sigma, min_pivot);
}

PatchDerivatives apply(const DerivativeFilters& filters, const PatchSamples& samples, float step) {
  Eigen::Matrix<double, 3, 5> d = Eigen::Matrix<double, 3, 5>::Zero();
  for (Eigen::Index i = 0; i < filters.rows(); ++i)
    d.noalias() +=
        samples[static_cast<std::size_t>(i)].position.head<3>().cast<double>() * filters.row(i);
  const double s1 = 1 / static_cast<double>(step);
  const double s2 = s1 * s1;
  const auto column = [&](int k, double scale) {
    return Eigen::Vector3f((scale * d.col(k)).cast<float>());
  };
  return {Eigen::Vector3f::Zero(), column(0, s1), column(1, s1),
          column(2, s2),           column(3, s2), column(4, s2)};
}

}  // namespace semigeo::kernels
