#include "bench/peers/agreement.hpp"

#include <cmath>
#include <limits>

#include "bench/support/quantile.hpp"
#include "kernels/surface/nearest_surface.hpp"

namespace semigeo::peers {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Returns the normal of a face, not of unit length.
Eigen::Vector3d face_normal(const kernels::Surface& surface, std::int32_t face) {
  const auto& t = surface.triangles[face];
  const Eigen::Vector3d a = surface.points[t[0]].cast<double>();
  return (surface.points[t[1]].cast<double>() - a).cross(surface.points[t[2]].cast<double>() - a);
}

/// Returns the barycentric coordinates of a point in the plane of a face.
Eigen::Vector3d barycentric(const kernels::Surface& surface, std::int32_t face,
                            const Eigen::Vector3d& p) {
  const auto& t = surface.triangles[face];
  const Eigen::Vector3d normal = face_normal(surface, face);
  Eigen::Vector3d weights;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = surface.points[t[(i + 1) % 3]].cast<double>();
    const Eigen::Vector3d b = surface.points[t[(i + 2) % 3]].cast<double>();
    weights[i] = (b - a).cross(p - a).dot(normal) / normal.squaredNorm();
  }
  return weights;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

}  // namespace

std::vector<SamePlace> same_places(const View& first, const View& second, double distance) {
  const kernels::NearestSurface nearest(second.surface);
  std::vector<Eigen::Vector3d> normals(first.surface.points.size(), Eigen::Vector3d::Zero());
  for (std::int32_t f = 0; f < first.surface.face_count(); ++f)
    for (const std::int32_t v : first.surface.triangles[f])
      normals[v] += face_normal(first.surface, f);
  std::vector<SamePlace> places;
  for (std::int32_t v = 0; v < first.surface.vertex_count(); ++v) {
    if (first.trusted[v] == 0) continue;
    const auto found = nearest.nearest(first.surface.points[v].cast<double>(), distance);
    if (found.face == kernels::kNone) continue;
    const auto& corners = second.surface.triangles[found.face];
    if (second.trusted[corners[0]] == 0 || second.trusted[corners[1]] == 0 ||
        second.trusted[corners[2]] == 0 ||
        face_normal(second.surface, found.face).dot(normals[v]) <= 0)
      continue;
    places.push_back({v, corners, barycentric(second.surface, found.face, found.point)});
  }
  return places;
}

void Comparison::add(std::span<const SamePlace> places, std::span<const double> first,
                     std::span<const double> second) {
  for (const SamePlace& place : places) {
    const double a = first[place.vertex];
    double b = 0;
    for (int i = 0; i < 3; ++i) b += place.weights[i] * second[place.corners[i]];
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    differences_.push_back(std::abs(a - b));
    values_.push_back(std::abs(a));
    values_.push_back(std::abs(b));
  }
}

Agreement Comparison::agreement() const {
  Agreement result;
  result.places = static_cast<std::int64_t>(differences_.size());
  std::vector<double> differences = differences_, values = values_;
  result.rms = rms(values);
  result.rms_difference = rms(differences) / result.rms;
  result.median_difference = bench::median(differences) / bench::median(values);
  return result;
}

AgreementRow at_equal_detail(std::span<const AgreementRow> rows, double rms) {
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    const AgreementRow &a = rows[i], &b = rows[i + 1];
    if (!(a.agreement.rms >= rms && rms >= b.agreement.rms)) continue;
    const double t = std::log(a.agreement.rms / rms) / std::log(a.agreement.rms / b.agreement.rms);
    const auto between = [t](double x, double y) {
      return std::exp(std::lerp(std::log(x), std::log(y), t));
    };
    AgreementRow row = a;
    row.size = between(a.size, b.size);
    row.microseconds = between(a.microseconds, b.microseconds);
    row.agreement.rms = rms;
    row.agreement.rms_difference = between(a.agreement.rms_difference, b.agreement.rms_difference);
    row.agreement.median_difference =
        between(a.agreement.median_difference, b.agreement.median_difference);
    return row;
  }
  return {"", kUnknown, kUnknown, {0, kUnknown, kUnknown, kUnknown}};
}

}  // namespace semigeo::peers
