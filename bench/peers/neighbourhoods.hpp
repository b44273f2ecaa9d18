#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::peers {

/// Collects the vertices round a vertex, as fits of polynomials need them. Not thread-safe.
class Neighbourhoods {
 public:
  /// Keeps a reference to the surface.
  explicit Neighbourhoods(const kernels::Surface& surface);

  /// Returns the vertex and whole rings of neighbours round it until there are at least `least`
  /// vertices, or no more. The result is valid until the next call.
  std::span<const std::int32_t> rings(std::int32_t vertex, std::size_t least);

  /// Returns the vertex and all vertices that are joined to it by edges within a ball of this
  /// radius; further rings are added if they are fewer than `least`. The result is valid until the
  /// next call.
  std::span<const std::int32_t> ball(std::int32_t vertex, double radius, std::size_t least);

 private:
  void start(std::int32_t vertex);
  void take(std::int32_t vertex);
  void add_rings(std::size_t least);

  const kernels::Surface& surface_;
  std::vector<std::uint32_t> seen_;  ///< (N) Number of the last call that reached the vertex.
  std::uint32_t call_ = 0;
  std::vector<std::int32_t> found_;
};

/// Returns for each vertex the number of edges to the nearest boundary, at most `most`.
std::vector<int> edges_to_boundary(const kernels::Surface& surface, int most);

}  // namespace semigeo::peers
