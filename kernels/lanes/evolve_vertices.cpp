#include "kernels/lanes/evolve_vertices.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "kernels/evolution/patch_estimate.hpp"
#include "kernels/lanes/patch_block.hpp"
#include "kernels/patch/polar_patch.hpp"

namespace semigeo::kernels {
namespace lanes {
namespace {

Ray ray_of(const BlockRay& ray) {
  return {{ray.halfedge, ray.x, ray.y}, ray.dx, ray.dy};
}

BlockRay block_ray_of(const Ray& ray) {
  return {ray.at.halfedge, ray.at.x, ray.at.y, ray.dx, ray.dy};
}

/// Returns the ray as a line starts along it.
BlockRay started(const GeodesicMesh& mesh, const Ray& ray) {
  return block_ray_of(GeodesicLine(mesh, ray).ray());
}

// Lanes read the arrays of a surface as plain numbers.
static_assert(sizeof(GeodesicFace) == 64 && offsetof(GeodesicFace, dot) == 48 &&
              offsetof(GeodesicFace::Edge, twin) == 8 &&
              offsetof(GeodesicFace::Edge, origin) == 12);
static_assert(sizeof(QuadraticFace) == 36 && sizeof(Eigen::Vector3f) == 12);

BlockSurface plain(const SampledSurface& surface) {
  const GeodesicMesh& mesh = surface.mesh;
  const auto floats = [](const auto& rows) { return reinterpret_cast<const float*>(rows.data()); };
  return {.edges = floats(mesh.faces),
          .points = floats(mesh.points),
          .normals = floats(mesh.normals),
          .bulges = surface.curved.empty() ? nullptr : floats(surface.curved),
          .outgoing = mesh.outgoing.data(),
          .max_crossings = mesh.max_crossings,
          .original = &surface};
}

/// Fills the tables that tell where the samples of lines go. The vertex itself, which is on no
/// line, is at the origin.
void fill_places(bool polar, BlockWorkspace& work) {
  for (int i = 0; i < kBlock; ++i) work.vertex_place[i] = (i / 4 * kSamples) * 16 + i % 4 * 4;
  const auto put = [&](int line, int k, int sample) {
    work.sample_place[line * kReach + k - 1] = 16 * sample;
  };
  if (polar) {
    for (int line = 0; line < kPolarLines; ++line)
      for (int k = 1; k <= kReach; ++k) put(line, k, line * kReach + k - 1);
    return;
  }
  for (auto& group : work.block.sample)
    for (auto& centre : group[kSamples / 2]) std::fill_n(centre, 4, 0.0f);
  const auto sample = [](int u, int v) { return (u + kReach) * kTaps + v + kReach; };
  for (int k = 1; k <= kReach; ++k) {
    put(kForward, k, sample(k, 0));
    put(kBackward, k, sample(-k, 0));
    put(kMiddleUp, k, sample(0, k));
    put(kMiddleDown, k, sample(0, -k));
    for (int j = 0; j < 2 * kReach; ++j) {
      const int u = j < kReach ? j + 1 : kReach - 1 - j;
      put(kFirstColumn + 2 * j, k, sample(u, k));
      put(kFirstColumn + 2 * j + 1, k, sample(u, -k));
    }
  }
}

Eigen::Vector4f sample_of(const PatchBlock& block, int i, int sample) {
  return Eigen::Vector4f::Map(block.sample[i / 4][sample][i % 4]);
}

void copy_patch(const PatchBlock& block, int i, Patch& patch) {
  const std::int8_t* reach = block.reach[i];
  for (int c = 0; c < kTaps; ++c) {
    const int u = c - kReach;
    const int j = u > 0 ? u - 1 : kReach - 1 - u;
    const int line = u == 0 ? kMiddleUp : kFirstColumn + 2 * j;
    const bool exists = u == 0 || std::abs(u) <= reach[u > 0 ? kForward : kBackward];
    patch.reach_up[c] = exists ? reach[line] : std::int8_t{-1};
    patch.reach_down[c] = exists ? reach[line + 1] : std::int8_t{-1};
    for (int r = 0; r < kTaps; ++r) patch.sample[c][r] = sample_of(block, i, c * kTaps + r);
  }
}

void copy_patch(const PatchBlock& block, int i, PolarPatch& patch) {
  for (int j = 0; j < kRays; ++j) {
    patch.reach[j] = block.reach[i][j];
    for (int k = 0; k < kReach; ++k) patch.sample[j][k] = sample_of(block, i, j * kReach + k);
  }
}

template <typename AnyPatch>
PatchEstimate estimate_copy(const PatchBlock& block, int i, float step) {
  AnyPatch patch;
  copy_patch(block, i, patch);
  return estimate(patch, step);
}

PatchEstimate estimate_of(const PatchBlock& block, int i, const PatchLayout& layout) {
  if (layout.coordinates == Coordinates::kPolar)
    return estimate_copy<PolarPatch>(block, i, layout.step);
  if (block.state[i] == PatchState::kTruncated) return estimate_copy<Patch>(block, i, layout.step);
  const auto row = [&](Derivative k) {
    return Eigen::Vector3f(Eigen::Vector3f::Map(block.derivative[k][i]));
  };
  const Eigen::Vector3f zero = Eigen::Vector3f::Zero();
  return {.moved = row(kR),
          .smoothed = {row(kR), row(kSmoothU), row(kSmoothV), zero, zero, zero},
          .fitted = {zero, row(kU), row(kV), row(kUU), row(kUV), row(kVV)},
          .completeness = 1,
          .valid = true};
}

TraceBlock* trace_block_of(InstructionSet set) {
#if defined(__x86_64__)
  if (set == InstructionSet::kAvx512) return avx512::trace_block;
  if (set == InstructionSet::kAvx2) return avx2::trace_block;
#endif
  return set == InstructionSet::kScalar ? nullptr : baseline::trace_block;
}

BlockWorkspace& workspace() {
  thread_local const std::unique_ptr<BlockWorkspace> work = std::make_unique<BlockWorkspace>();
  return *work;
}

}  // namespace

BlockRay scalar_ray_from_vertex(const BlockSurface& surface, std::int32_t v,
                                const float (&direction)[3]) {
  return block_ray_of(ray_from_vertex(surface.original->mesh, v, Eigen::Vector3f::Map(direction)));
}

void scalar_perpendiculars(const BlockSurface& surface, const BlockRay& ray, BlockRay& left,
                           BlockRay& right) {
  const GeodesicMesh& mesh = surface.original->mesh;
  const Perpendiculars sides = perpendiculars(mesh, ray_of(ray));
  left = started(mesh, sides.left);
  right = started(mesh, sides.right);
}

}  // namespace lanes

std::int64_t evolve_vertices(const SampledSurface& surface, std::span<const std::int32_t> first,
                             const PatchLayout& layout, InstructionSet set,
                             std::span<EvolvedVertex> results) {
  using namespace lanes;
  const GeodesicMesh& mesh = surface.mesh;
  TraceBlock* const trace = trace_block_of(set);
  std::int64_t left_to_scalar = 0;
  const auto by_scalar = [&](std::size_t i) {
    ++left_to_scalar;
    PatchLayout own = layout;
    own.first = first[i];
    results[i] = evolve_vertex(surface, mesh.origin(first[i]), own);
  };
  if (trace == nullptr || mesh.max_crossings > kMostCrossings) {
    for (std::size_t i = 0; i < first.size(); ++i) by_scalar(i);
    return left_to_scalar;
  }
  BlockWorkspace& work = workspace();
  const bool polar = layout.coordinates == Coordinates::kPolar;
  fill_places(polar, work);
  const auto taps = savitzky_golay_filters().taps();
  const BlockFilters filters = {.smooth = gaussian_filters().smooth.data(),
                                .first = gaussian_filters().first.data(),
                                .taps = taps.data(),
                                .tap_count = static_cast<int>(taps.size())};
  const BlockSurface block_surface = plain(surface);
  for (std::size_t begin = 0; begin < first.size(); begin += kBlock) {
    const int count = static_cast<int>(std::min<std::size_t>(kBlock, first.size() - begin));
    for (int i = 0; i < count; ++i) {
      work.vertex[i] = mesh.origin(first[begin + i]);
      Eigen::Vector4f::Map(work.centre[i]) = mesh.points[work.vertex[i]];
      work.block.state[i] = PatchState::kWhole;
      std::fill_n(work.block.reach[i], kLines, static_cast<std::int8_t>(kReach));
    }
    trace(block_surface, filters,
          {.first = first.data() + begin,
           .count = count,
           .step = layout.step,
           .polar = polar,
           .ray_directions = ray_directions().front().data()},
          work);
    for (int i = 0; i < count; ++i) {
      if (work.block.state[i] == PatchState::kNone)
        by_scalar(begin + i);
      else
        results[begin + i] =
            evolved_vertex(surface, work.vertex[i], layout, estimate_of(work.block, i, layout));
    }
  }
  return left_to_scalar;
}

}  // namespace semigeo::kernels
