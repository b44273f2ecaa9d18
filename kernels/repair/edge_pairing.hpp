#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/repair/coincident_faces.hpp"
#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Tells which faces of a triangle list join, and what was done to decide it.
struct PairedEdges {
  std::vector<std::int32_t> twin;      ///< (4 F) The half-edge that each one joins, or kNone.
  std::int64_t flipped_faces = 0;      ///< Turned over to agree with their neighbours.
  std::int64_t nonmanifold_edges = 0;  ///< Cut apart, wholly or into pairs of faces.
};

/// Decides at each edge which faces join, whatever the number of faces there, and orients joined
/// faces alike. Faces are turned over in place, but none is dropped:
/// - Two faces join, unless they cannot be oriented alike (a Moebius strip is cut).
/// - Of more than two, those join that share both vertices of the file, if they are just two.
/// - Of the others those join that are two of one surface, which is connected elsewhere.
/// - Of the others those join that bound the same wedge of material, by their angle round the edge:
///   solids that touch along an edge come apart.
///
/// The majority of each connected set of faces keeps its orientation. `points` (N) are the places
/// of the faces. No triangle may repeat a place. The cost is nearly linear.
PairedEdges pair_edges(Faces& faces, std::span<const Eigen::Vector3f> points);

}  // namespace semigeo::kernels
