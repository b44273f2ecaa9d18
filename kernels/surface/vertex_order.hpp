#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// An order of the vertices in which neighbours in space are neighbours in memory: by connected
/// part, then along a Z-order curve. result[i] = old index of new vertex i. A patch then finds all
/// it touches in the first-level cache, and every part is one range of vertices.
std::vector<std::int32_t> locality_order(const Surface& surface);

/// The same surface with vertex i = old vertex order[i]; faces are sorted by their lowest new
/// vertex, so every part is also one range of faces. Connectivity follows; parts keep their numbers
/// when the order is one of `locality_order`. Gaps are closed: vertices without faces may be left
/// out, faces whose corners are kNone are. Without points the result has none. `face_order` takes
/// the old index of each face.
Surface reordered(const Surface& surface, const std::vector<std::int32_t>& order,
                  std::vector<std::int32_t>* face_order = nullptr);

/// What vertices or faces carry, in their new order: result[i] = values[order[i]]. Nothing stays
/// nothing.
template <typename Value>
std::vector<Value> gathered(const std::vector<Value>& values,
                            const std::vector<std::int32_t>& order) {
  std::vector<Value> result(values.empty() ? 0 : order.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = values[order[i]];
  return result;
}

}  // namespace semigeo::kernels
