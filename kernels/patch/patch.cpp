#include "kernels/patch/patch.hpp"

#include <Eigen/Geometry>

namespace semigeo::kernels {
namespace {

/// Fills one half of a column, outwards from its base sample. Returns the number of samples that
/// exist.
std::int8_t trace_half_column(const SampledSurface& surface, const Ray& start, float step,
                              const Eigen::Vector4f& centre, Eigen::Vector4f* base, int stride) {
  GeodesicLine line(surface.mesh, start);
  std::int8_t reach = 0;
  while (reach < kReach && line.advance(step)) {
    ++reach;
    base[reach * stride] = sample_position(surface, line.ray().at, centre);
  }
  return reach;
}

/// Fills a column whose base sample is at `base` with u pointing along it.
void trace_column(const SampledSurface& surface, const Ray& base, float step,
                  const Eigen::Vector4f& centre, int column, Patch& patch) {
  Eigen::Vector4f* middle = &patch.sample[column][kReach];
  *middle = sample_position(surface, base.at, centre);
  const auto [up, down] = perpendiculars(surface.mesh, base);
  patch.reach_up[column] = trace_half_column(surface, up, step, centre, middle, 1);
  patch.reach_down[column] = trace_half_column(surface, down, step, centre, middle, -1);
}

}  // namespace

bool Patch::whole() const {
  int missing = 0;
  for (int c = 0; c < kTaps; ++c) missing += 2 * kReach - reach_up[c] - reach_down[c];
  return missing == 0;
}

float Patch::completeness() const {
  const auto& g = gaussian_filters().smooth;
  float sum = 0;
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r)
      if (has(c, r)) sum += g[c] * g[r];
  return sum;
}

Eigen::Vector3f Patch::paired_mean() const {
  const auto& g = gaussian_filters().smooth;
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r)
      if (has(c, r) && has(kTaps - 1 - c, kTaps - 1 - r)) sum += g[c] * g[r] * sample[c][r];
  return sum.head<3>();
}

PatchSamples Patch::samples() const {
  PatchSamples samples;
  for (int c = 0; c < kTaps; ++c)
    for (int r = 0; r < kTaps; ++r)
      if (has(c, r))
        samples.push_back(
            {static_cast<float>(c - kReach), static_cast<float>(r - kReach), 1, sample[c][r]});
  return samples;
}

std::int32_t first_edge(const GeodesicMesh& mesh, std::int32_t v) {
  const std::int32_t start = mesh.outgoing[v];
  if (mesh.twin(start) != kNone) return start;
  int count = 0;
  for (std::int32_t h = start; h != kNone; h = mesh.twin(prev(h))) ++count;
  std::int32_t h = start;
  for (int k = 0; k < count / 2; ++k) h = mesh.twin(prev(h));
  return h;
}

void trace_patch(const SampledSurface& surface, std::int32_t v, std::int32_t first, float step,
                 Patch& patch) {
  const GeodesicMesh& mesh = surface.mesh;
  const Eigen::Vector4f centre = mesh.points[v];
  const Eigen::Vector3f edge = mesh.point(mesh.origin(next(first))) - mesh.point(v);
  const float length = edge.norm();
  patch.reach_up.fill(-1);
  patch.reach_down.fill(-1);

  patch.sample[kReach][kReach].setZero();
  patch.reach_up[kReach] = patch.reach_down[kReach] = 0;
  if (!(length > 0)) return;

  // Figure 5.4: u < 0 along the edge, u > 0 in its normal plane beyond the vertex.
  const Eigen::Vector3f u = -edge / length;
  const Eigen::Vector3f& w = mesh.normals[v];
  Eigen::Vector4f* middle = &patch.sample[kReach][kReach];
  patch.reach_up[kReach] =
      trace_half_column(surface, ray_from_vertex(mesh, v, w.cross(u)), step, centre, middle, 1);
  patch.reach_down[kReach] =
      trace_half_column(surface, ray_from_vertex(mesh, v, u.cross(w)), step, centre, middle, -1);

  GeodesicLine forward(mesh, ray_from_vertex(mesh, v, u));
  for (int i = 1; i <= kReach && forward.advance(step); ++i)
    trace_column(surface, forward.ray(), step, centre, kReach + i, patch);

  GeodesicLine backward(mesh, Ray{{first, 0, 0}, 1 / length, 0});
  for (int i = 1; i <= kReach && backward.advance(step); ++i)
    trace_column(surface, reversed(backward.ray()), step, centre, kReach - i, patch);
}

}  // namespace semigeo::kernels
