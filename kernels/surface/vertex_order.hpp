#pragma once

#include <cstdint>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// Returns an order of the vertices in which neighbours in space are neighbours in memory: by
/// connected part, then along a Z-order curve. result[i] is the old index of new vertex i. Then
/// all that a patch reads is in the first-level cache, and every part is one range of vertices.
std::vector<std::int32_t> locality_order(const Surface& surface);

/// Returns the same mesh with vertex i = old vertex order[i]. Faces are sorted by their lowest new
/// vertex. Removed faces are left out, and `order` may leave out vertices without faces.
/// `face_order` receives the old index of each face. The cost is linear.
Connectivity reordered(const Connectivity& mesh, const std::vector<std::int32_t>& order,
                       std::vector<std::int32_t>* face_order = nullptr);

/// Returns the mesh without removed vertices and faces. The others keep their order.
/// `source_vertex` receives the old index of each vertex. The cost is linear.
Connectivity compacted(const Connectivity& mesh, std::vector<std::int32_t>& source_vertex);

/// Returns the same surface in another order, as above. Parts keep their numbers when the order is
/// one of `locality_order`; then every part is also one range of faces.
Surface reordered(const Surface& surface, const std::vector<std::int32_t>& order,
                  std::vector<std::int32_t>* face_order = nullptr);

}  // namespace semigeo::kernels
