#include "kernels/surface/connectivity.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {

void choose_outgoing(Connectivity& mesh, std::int64_t vertex_count) {
  mesh.outgoing.assign(vertex_count, kNone);
  const auto face_count = static_cast<std::int32_t>(mesh.face_count());
  for (std::int32_t f = 0; f < face_count; ++f)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      std::int32_t& chosen = mesh.outgoing[mesh.origin(h)];
      if (chosen == kNone || mesh.twin[h] == kNone) chosen = h;
    }
}

Connectivity connect(std::vector<Triangle> triangles, std::int64_t vertex_count) {
  Connectivity mesh;
  mesh.twin = pair_twins(group_edges(triangles, vertex_count), triangles.size());
  mesh.triangles = std::move(triangles);
  choose_outgoing(mesh, vertex_count);
  return mesh;
}

std::int32_t find_edge(const Connectivity& mesh, std::int32_t a, std::int32_t b) {
  // Both fans are walked at the same time, until the smaller one ends.
  const std::array<std::int32_t, 2> start = {mesh.outgoing[a], mesh.outgoing[b]};
  std::array<std::int32_t, 2> h = start;
  while (true)
    for (int side = 0; side < 2; ++side) {
      const std::int32_t sought = side == 0 ? b : a;
      if (mesh.target(h[side]) == sought) return h[side];
      if (mesh.origin(prev(h[side])) == sought) return prev(h[side]);
      h[side] = mesh.ccw(h[side]);
      if (h[side] == kNone || h[side] == start[side]) return kNone;
    }
}

std::int32_t number_parts(const Connectivity& mesh, std::vector<std::int32_t>& part) {
  // Until the end, `part` has the parent of each vertex in a forest: its root is the first vertex
  // of a part.
  part.resize(mesh.vertex_count());
  std::iota(part.begin(), part.end(), 0);
  const auto root_of = [&](std::int32_t v) {
    while (part[v] != v) {
      part[v] = part[part[v]];
      v = part[v];
    }
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == kNone) continue;
    for (int i = 1; i < 3; ++i) {
      const std::int32_t a = root_of(t[0]);
      const std::int32_t b = root_of(t[i]);
      part[std::max(a, b)] = std::min(a, b);
    }
  }
  std::int32_t part_count = 0;
  const auto vertex_count = static_cast<std::int32_t>(part.size());
  for (std::int32_t v = 0; v < vertex_count; ++v)
    part[v] = part[v] == v ? part_count++ : part[part[v]];  // parents come first and are done
  return part_count;
}

}  // namespace semigeo::kernels
