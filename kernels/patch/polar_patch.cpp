#include "kernels/patch/polar_patch.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "kernels/patch/derivative_filters.hpp"
#include "kernels/patch/savitzky_golay.hpp"

namespace semigeo::kernels {
namespace {

struct Weights {
  std::array<double, kReach + 1> sample;  ///< of one sample
  double variance;                        ///< along an axis
};

/// Returns the Gaussian of `sigma` integrated over the disc of half a step and over rings of one
/// step.
Weights ring_weights(double sigma) {
  const auto outside = [&](double radius) {
    return std::exp(-radius * radius / (2 * sigma * sigma));
  };
  Weights w{};
  const double total = 1 - outside(kReach + 0.5);
  w.sample[0] = (1 - outside(0.5)) / total;
  for (int k = 1; k <= kReach; ++k) {
    const double ring = (outside(k - 0.5) - outside(k + 0.5)) / total;
    w.sample[k] = ring / kRays;
    w.variance += ring * k * k / 2;
  }
  return w;
}

std::array<float, kReach + 1> make_weights() {
  double low = 0.5;
  double high = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (ring_weights(middle).variance < gaussian_filters().variance ? low : high) = middle;
  }
  std::array<float, kReach + 1> weights{};
  for (int k = 0; k <= kReach; ++k) weights[k] = static_cast<float>(ring_weights(low).sample[k]);
  return weights;
}

double angle(int ray) {
  return 2 * std::numbers::pi * ray / kRays;
}

/// Holds filters for a whole patch, made once; `samples()` of every whole patch has the same order.
DerivativeFilters whole_filters(bool fitted) {
  PolarPatch patch;
  patch.reach.fill(kReach);
  for (auto& ray : patch.sample) ray.fill(Eigen::Vector4f::Zero());
  const PatchSamples samples = patch.samples();
  return fitted ? *quartic_filters(samples, kFitSigma, 0) : *quadratic_filters(samples, 1, 0);
}

}  // namespace

const std::array<Eigen::Vector2f, kRays>& ray_directions() {
  static const std::array<Eigen::Vector2f, kRays> directions = [] {
    std::array<Eigen::Vector2f, kRays> d;
    for (int j = 0; j < kRays; ++j)
      d[j] = {static_cast<float>(std::cos(angle(j))), static_cast<float>(std::sin(angle(j)))};
    return d;
  }();
  return directions;
}

const std::array<float, kReach + 1>& polar_weights() {
  static const std::array<float, kReach + 1> weights = make_weights();
  return weights;
}

bool PolarPatch::whole() const {
  for (const std::int8_t r : reach)
    if (r < kReach) return false;
  return true;
}

float PolarPatch::completeness() const {
  const auto& weights = polar_weights();
  float sum = weights[0];
  for (const std::int8_t r : reach)
    for (int k = 1; k <= r; ++k) sum += weights[k];
  return sum;
}

Eigen::Vector3f PolarPatch::paired_mean() const {
  const auto& weights = polar_weights();
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int j = 0; j < kRays / 2; ++j) {
    const int opposite = j + kRays / 2;
    for (int k = 1; k <= std::min(reach[j], reach[opposite]); ++k)
      sum += weights[k] * (sample[j][k - 1] + sample[opposite][k - 1]);
  }
  return sum.head<3>();
}

PatchSamples PolarPatch::samples() const {
  PatchSamples samples;
  samples.push_back({0, 0, std::numbers::pi_v<float> / 4, Eigen::Vector4f::Zero()});
  for (int j = 0; j < kRays; ++j) {
    const Eigen::Vector2f& d = ray_directions()[j];
    for (int k = 1; k <= reach[j]; ++k) {
      const auto radius = static_cast<float>(k);
      samples.push_back({radius * d.x(), radius * d.y(), static_cast<float>(angle(1)) * radius,
                         sample[j][k - 1]});
    }
  }
  return samples;
}

PatchDerivatives convolve_tangents(const PolarPatch& patch, float step) {
  static const DerivativeFilters filters = whole_filters(false);
  return apply(filters, patch.samples(), step);
}

PatchDerivatives fit(const PolarPatch& patch, float step) {
  static const DerivativeFilters filters = whole_filters(true);
  return apply(filters, patch.samples(), step);
}

void trace_polar_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first,
                       float step, PolarPatch& patch) {
  const GeodesicMesh& mesh = surface.mesh;
  const Eigen::Vector4f centre = mesh.points[v];
  const Eigen::Vector3f edge = mesh.point(mesh.origin(next(first))) - mesh.point(v);
  const float length = edge.norm();
  patch.reach.fill(0);
  if (!(length > 0)) return;

  const Eigen::Vector3f& w = mesh.normals[v];
  const Eigen::Vector3f along = edge - edge.dot(w) * w;
  const Eigen::Vector3f across = w.cross(edge);
  for (int j = 0; j < kRays; ++j) {
    const Eigen::Vector2f& d = ray_directions()[j];
    const Ray start =
        j == 0 ? Ray{{first, 0, 0}, 1 / length, 0}
               : ray_from_vertex(mesh, v, d.x() * along + d.y() * across);  // 5.4: N about W
    GeodesicLine line(mesh, start);
    while (patch.reach[j] < kReach && line.advance(step)) {
      patch.sample[j][patch.reach[j]] = sample_position(surface, line.ray().at, centre);
      ++patch.reach[j];
    }
  }
}

}  // namespace semigeo::kernels
