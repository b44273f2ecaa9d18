#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::tests {

/// Why a mesh is no oriented manifold; empty if it is one. Vertices count as they are numbered:
/// those at one place may be several.
inline std::string why_not_manifold(const kernels::TriangleMesh& mesh) {
  using Edge = std::pair<std::int32_t, std::int32_t>;
  std::map<Edge, std::int32_t> third;  // corner opposite to a directed edge
  std::vector<std::int32_t> corners(mesh.points.size(), 0);
  std::map<std::int32_t, Edge> spoke;  // where to start round a vertex: at its boundary if any
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = t[i], b = t[(i + 1) % 3];
      if (a == b) return "degenerate face at vertex " + std::to_string(a);
      if (!third.try_emplace({a, b}, t[(i + 2) % 3]).second)
        return "two faces along edge " + std::to_string(a) + " " + std::to_string(b);
      ++corners[a];
    }
  for (const auto& [edge, opposite] : third)
    if (!spoke.contains(edge.first) || !third.contains({edge.second, edge.first}))
      spoke[edge.first] = edge;
  for (std::size_t v = 0; v < corners.size(); ++v) {
    if (corners[v] == 0) return "no face at vertex " + std::to_string(v);
    const Edge start = spoke.at(static_cast<std::int32_t>(v));
    std::int32_t seen = 0;
    for (auto at = third.find(start); at != third.end() && seen <= corners[v];) {
      ++seen;
      at = third.find({at->first.first, at->second});
      if (at != third.end() && at->first == start) break;
    }
    if (seen != corners[v]) return "several fans at vertex " + std::to_string(v);
  }
  return {};
}

}  // namespace semigeo::tests
