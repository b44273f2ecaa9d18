#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Holds the half-edges of a triangle list, grouped by undirected edge.
struct EdgeGroups {
  std::vector<std::int32_t> members;  ///< (3 F) Half-edges 4 f + i, edge after edge, ascending
                                      ///< within an edge.
  std::vector<std::int32_t> begin;    ///< (E + 1) First member of each edge.
  std::int64_t edge_count() const { return static_cast<std::int64_t>(begin.size()) - 1; }
  /// Returns the half-edges of edge e.
  std::span<const std::int32_t> edge(std::int64_t e) const {
    return std::span(members).subspan(begin[e], begin[e + 1] - begin[e]);
  }
};

/// Groups the half-edges of triangles over `vertex_count` vertices. No triangle may repeat a
/// vertex. The cost is nearly linear.
EdgeGroups group_edges(std::span<const Triangle> triangles, std::int64_t vertex_count);

/// Returns for each half-edge (4 F) the other half-edge of its edge, or kNone where an edge does
/// not have exactly two.
std::vector<std::int32_t> pair_twins(const EdgeGroups& groups, std::size_t face_count);

}  // namespace semigeo::kernels
