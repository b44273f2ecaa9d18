#include "kernels/surface/vertex_order.hpp"

#include <algorithm>
#include <utility>

#include "kernels/surface/bounding_box.hpp"
#include "kernels/surface/vertex_rows.hpp"
#include "kernels/surface/z_order.hpp"

namespace semigeo::kernels {
namespace {

/// Returns the place of each of `size` indices in `order`, or kNone for those that are missing.
std::vector<std::int32_t> positions(const std::vector<std::int32_t>& order, std::size_t size) {
  std::vector<std::int32_t> result(size, kNone);
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<std::int32_t>(i);
  return result;
}

/// Returns the mesh whose vertex i is old vertex `vertices`[i] and whose face i is old face
/// `faces`[i]; `new_vertex` is the inverse of `vertices`.
Connectivity renumbered(const Connectivity& mesh, const std::vector<std::int32_t>& vertices,
                        const std::vector<std::int32_t>& new_vertex,
                        const std::vector<std::int32_t>& faces) {
  const std::vector<std::int32_t> new_face = positions(faces, mesh.triangles.size());
  const auto moved = [&](std::int32_t h) {
    return h == kNone ? kNone : halfedge(new_face[face_of(h)], corner_of(h));
  };
  Connectivity result;
  result.triangles.resize(faces.size());
  result.twin.assign(4 * faces.size(), kNone);
  for (std::size_t k = 0; k < faces.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(faces[k], i);
      result.triangles[k][i] = new_vertex[mesh.origin(h)];
      result.twin[halfedge(static_cast<std::int32_t>(k), i)] = moved(mesh.twin[h]);
    }
  result.outgoing.resize(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i)
    result.outgoing[i] = moved(mesh.outgoing[vertices[i]]);
  return result;
}

}  // namespace

std::vector<std::int32_t> locality_order(const Surface& surface) {
  if (surface.points.empty()) return {};
  const Eigen::AlignedBox3f box = bounding_box(surface.points);
  const double extent = box.sizes().cast<double>().maxCoeff();
  const double cells = extent > 0 ? ((1 << 21) - 1) / extent : 0;

  struct Key {
    std::int32_t part;
    std::int32_t vertex;
    std::uint64_t code;
  };
  std::vector<Key> keys(surface.points.size());
  for (std::size_t v = 0; v < keys.size(); ++v) {
    const Eigen::Vector3d q = (surface.points[v] - box.min()).cast<double>() * cells;
    const std::uint64_t code = spread_bits(static_cast<std::uint64_t>(q.x())) |
                               spread_bits(static_cast<std::uint64_t>(q.y())) << 1 |
                               spread_bits(static_cast<std::uint64_t>(q.z())) << 2;
    keys[v] = {surface.part[v], static_cast<std::int32_t>(v), code};
  }
  std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
    if (a.part != b.part) return a.part < b.part;
    return std::pair(a.code, a.vertex) < std::pair(b.code, b.vertex);
  });
  std::vector<std::int32_t> order(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].vertex;
  return order;
}

Connectivity reordered(const Connectivity& mesh, const std::vector<std::int32_t>& order,
                       std::vector<std::int32_t>* face_order) {
  const std::vector<std::int32_t> new_vertex = positions(order, mesh.outgoing.size());
  // The faces are sorted by their lowest new vertex, with a counting sort.
  const auto lowest = [&](const Triangle& t) {
    return std::min({new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]});
  };
  std::vector<std::int32_t> cursor(order.size() + 1, 0);
  for (const Triangle& t : mesh.triangles)
    if (t[0] != kNone) ++cursor[lowest(t) + 1];
  for (std::size_t v = 0; v < order.size(); ++v) cursor[v + 1] += cursor[v];
  std::vector<std::int32_t> faces(cursor.back());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (mesh.triangles[f][0] != kNone)
      faces[cursor[lowest(mesh.triangles[f])]++] = static_cast<std::int32_t>(f);
  Connectivity result = renumbered(mesh, order, new_vertex, faces);
  if (face_order != nullptr) *face_order = std::move(faces);
  return result;
}

Connectivity compacted(const Connectivity& mesh, std::vector<std::int32_t>& source_vertex) {
  source_vertex.clear();
  for (std::size_t v = 0; v < mesh.outgoing.size(); ++v)
    if (mesh.outgoing[v] != kNone) source_vertex.push_back(static_cast<std::int32_t>(v));
  std::vector<std::int32_t> faces;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    if (mesh.triangles[f][0] != kNone) faces.push_back(static_cast<std::int32_t>(f));
  return renumbered(mesh, source_vertex, positions(source_vertex, mesh.outgoing.size()), faces);
}

Surface reordered(const Surface& surface, const std::vector<std::int32_t>& order,
                  std::vector<std::int32_t>* face_order) {
  return {reordered(static_cast<const Connectivity&>(surface), order, face_order),
          gathered(surface.points, order), gathered(surface.part, order), surface.part_count};
}

}  // namespace semigeo::kernels
