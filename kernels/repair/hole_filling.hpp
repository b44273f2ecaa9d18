#pragma once

#include <cstdint>
#include <vector>

#include "kernels/repair/hole_patch.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Returns all boundary loops, by part and then by lowest vertex. Holes that touch in a vertex,
/// which has a copy for each of its fans, are loops of their own that are joined there. The longest
/// loop of a part is its outer boundary, the end of what was scanned, if it spans the part. It does
/// so if the magnitude of its vector area is at least a tenth of the area of the part, or if its
/// vertices lie on average at least half as far from their centroid as those of the part from
/// theirs. (The vector area of a flat sheet's outline is its area, that of a hemisphere's rim half
/// of it; a round hole has a tenth when a tenth of the sphere is missing. The second rule covers
/// sheets that are rolled up.) The cost is linear.
std::vector<BoundaryLoop> boundary_loops(const Surface& surface);

/// Counts which boundary loops were filled, and why the others were left open.
struct HoleCounts {
  std::int64_t loops = 0;         ///< Number of all loops.
  std::int64_t filled = 0;        ///< Number of loops that were filled.
  std::int64_t outer = 0;         ///< Number of loops that are outer boundaries.
  std::int64_t too_long = 0;      ///< Number of loops with more edges than the limit.
  std::int64_t unsplittable = 0;  ///< Number of loops that have no valid filling.

  bool operator==(const HoleCounts&) const = default;
};

/// Holds a surface with filled holes.
struct FilledSurface {
  /// Old vertices and faces come first, in their order. Copies that a patch has joined are one
  /// vertex again.
  Surface surface;
  std::vector<std::uint8_t> vertex_filled;  ///< (N) 1 where filling made the vertex.
  std::vector<std::uint8_t> face_filled;    ///< (F) 1 where filling made the face.
  HoleCounts counts;
};

/// Tells whether a loop is a hole of at most `max_edges` edges.
bool fillable(const BoundaryLoop& loop, std::int64_t max_edges);

/// Joins patches to the surface and counts them. `loops` are all loops of the surface;
/// `patches[k]`, made by `make_hole_patch`, fills `loops[k]` if that is fillable and the patch not
/// empty. The cost is linear.
FilledSurface insert_patches(const Surface& surface, const std::vector<BoundaryLoop>& loops,
                             const std::vector<HolePatch>& patches, std::int64_t max_edges);

/// Fills every hole of at most `max_edges` edges except the outer boundaries. No edge becomes
/// non-manifold, and faces are oriented like their neighbours. A hole that cannot be filled is left
/// and counted, which is no error. The function is serial. To fill holes on several threads, call
/// `boundary_loops`, `make_hole_patch` for each fillable loop, and `insert_patches`. Source: thesis
/// 5.1.
FilledSurface fill_holes(const Surface& surface, std::int64_t max_edges,
                         const HolePatchOptions& options = {});

}  // namespace semigeo::kernels
