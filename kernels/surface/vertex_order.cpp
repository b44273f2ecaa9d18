#include "kernels/surface/vertex_order.hpp"

#include <algorithm>
#include <utility>

#include "kernels/surface/z_order.hpp"

namespace semigeo::kernels {

std::vector<std::int32_t> locality_order(const Surface& surface) {
  if (surface.points.empty()) return {};
  Eigen::Vector3f low = surface.points.front();
  Eigen::Vector3f high = low;
  for (const auto& p : surface.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double extent = (high - low).cast<double>().maxCoeff();
  const double cells = extent > 0 ? ((1 << 21) - 1) / extent : 0;

  struct Key {
    std::int32_t part;
    std::int32_t vertex;
    std::uint64_t code;
  };
  std::vector<Key> keys(surface.points.size());
  for (std::size_t v = 0; v < keys.size(); ++v) {
    const Eigen::Vector3d q = (surface.points[v] - low).cast<double>() * cells;
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

Surface reordered(const Surface& surface, const std::vector<std::int32_t>& order,
                  std::vector<std::int32_t>* face_order) {
  Surface result;
  const std::size_t n = order.size();
  if (!surface.points.empty()) result.points.resize(n);
  result.part.resize(n);
  result.part_count = surface.part_count;
  std::vector<std::int32_t> new_vertex(surface.outgoing.size(), kNone);
  for (std::size_t i = 0; i < n; ++i) {
    if (!surface.points.empty()) result.points[i] = surface.points[order[i]];
    result.part[i] = surface.part[order[i]];
    new_vertex[order[i]] = static_cast<std::int32_t>(i);
  }

  // Counting sort of the faces by lowest new vertex.
  const auto lowest = [&](const std::array<std::int32_t, 3>& t) {
    return std::min({new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]});
  };
  std::vector<std::int32_t> cursor(n + 1, 0);
  std::size_t face_count = 0;
  for (const auto& t : surface.triangles) {
    if (t[0] == kNone) continue;
    ++cursor[lowest(t) + 1];
    ++face_count;
  }
  for (std::size_t v = 0; v < n; ++v) cursor[v + 1] += cursor[v];
  std::vector<std::int32_t> new_face(surface.triangles.size(), kNone);
  result.triangles.resize(face_count);
  if (face_order != nullptr) face_order->resize(face_count);
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    const auto& t = surface.triangles[f];
    if (t[0] == kNone) continue;
    new_face[f] = cursor[lowest(t)]++;
    result.triangles[new_face[f]] = {new_vertex[t[0]], new_vertex[t[1]], new_vertex[t[2]]};
    if (face_order != nullptr) (*face_order)[new_face[f]] = static_cast<std::int32_t>(f);
  }

  const auto moved = [&](std::int32_t h) {
    return h == kNone ? kNone : halfedge(new_face[face_of(h)], corner_of(h));
  };
  result.twin.assign(4 * face_count, kNone);
  for (std::size_t f = 0; f < surface.triangles.size(); ++f)
    for (int i = 0; i < 3 && new_face[f] != kNone; ++i) {
      const std::int32_t h = halfedge(static_cast<std::int32_t>(f), i);
      result.twin[moved(h)] = moved(surface.twin[h]);
    }
  result.outgoing.resize(n);
  for (std::size_t i = 0; i < n; ++i) result.outgoing[i] = moved(surface.outgoing[order[i]]);
  return result;
}

}  // namespace semigeo::kernels
