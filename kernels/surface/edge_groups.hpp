#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace semigeo::kernels {

/// The half-edges of a triangle list, grouped by undirected edge.
struct EdgeGroups {
  std::vector<std::int32_t> members;  ///< (3 F) half-edges 4 f + i, one edge's next to each other,
                                      ///< ascending within an edge
  std::vector<std::int32_t> begin;    ///< (E + 1) first member of each edge
  std::int64_t edge_count() const { return static_cast<std::int64_t>(begin.size()) - 1; }
  std::span<const std::int32_t> edge(std::int64_t e) const {
    return std::span(members).subspan(begin[e], begin[e + 1] - begin[e]);
  }
};

/// Groups the half-edges of triangles over `vertex_count` vertices. No triangle may repeat a
/// vertex.
EdgeGroups group_edges(std::span<const std::array<std::int32_t, 3>> triangles,
                       std::int64_t vertex_count);

/// For each half-edge (4 F) the one other half-edge of an edge that has exactly two, else -1.
std::vector<std::int32_t> pair_twins(const EdgeGroups& groups, std::size_t face_count);

}  // namespace semigeo::kernels
