#pragma once

#include <cstdint>
#include <vector>

#include "kernels/repair/hole_patch.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// A closed chain of boundary edges.
struct BoundaryLoop {
  std::vector<std::int32_t> vertices;  ///< in the order in which faces that fill it run along it
  std::int32_t part = 0;
  double length = 0;
  bool outer = false;  ///< the outer boundary of an open part
};

/// All boundary loops, by part and then by lowest vertex. The longest loop of a part is its outer
/// boundary, the end of what was scanned, if it spans the part: if the magnitude of its vector area
/// is at least a tenth of the area of the part, or its vertices lie on average at least half as far
/// from their centroid as those of the part from theirs. (The vector area of a flat sheet's outline
/// is its area, that of a hemisphere's rim half; a round hole has a tenth when a tenth of the
/// sphere is missing. The second rule covers sheets that are rolled up.) Linear cost.
std::vector<BoundaryLoop> boundary_loops(const Surface& surface);

/// What became of the boundary loops.
struct HoleCounts {
  std::int64_t loops = 0;
  std::int64_t filled = 0;
  std::int64_t outer = 0;         ///< left: outer boundary of an open part
  std::int64_t too_long = 0;      ///< left: more edges than the limit
  std::int64_t unsplittable = 0;  ///< left: some sub-loop has no valid split

  bool operator==(const HoleCounts&) const = default;
};

struct FilledSurface {
  Surface surface;  ///< old vertices and faces keep their indices, those of the patches follow
  std::vector<std::uint8_t> vertex_filled;  ///< (N) 1 = made by filling
  std::vector<std::uint8_t> face_filled;    ///< (F)
  HoleCounts counts;
};

/// Whether a loop is a hole of at most `max_edges` edges.
bool fillable(const BoundaryLoop& loop, std::int64_t max_edges);

/// Joins patches to the surface and counts: `patches[k]`, made by `make_hole_patch`, fills
/// `loops[k]`, of all loops of the surface, if that is fillable and the patch not empty. Linear
/// cost.
FilledSurface insert_patches(const Surface& surface, const std::vector<BoundaryLoop>& loops,
                             const std::vector<HolePatch>& patches, std::int64_t max_edges);

/// Fills every hole of at most `max_edges` edges but the outer boundaries. Never makes a
/// non-manifold edge; faces are oriented like their neighbours. A hole that cannot be split is left
/// and counted, which is no error. Serial; to share the work out, call `boundary_loops`,
/// `make_hole_patch` for each fillable loop, and `insert_patches`. Source: thesis 5.1.
FilledSurface fill_holes(const Surface& surface, std::int64_t max_edges,
                         const HolePatchOptions& options = {});

}  // namespace semigeo::kernels
