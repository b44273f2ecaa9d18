#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

namespace {

void choose_outgoing(Surface& surface) {
  surface.outgoing.assign(surface.points.size(), kNone);
  const auto face_count = static_cast<std::int32_t>(surface.face_count());
  for (std::int32_t f = 0; f < face_count; ++f)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      std::int32_t& chosen = surface.outgoing[surface.origin(h)];
      if (chosen == kNone || surface.twin[h] == kNone) chosen = h;
    }
}

}  // namespace

void number_parts(Surface& surface) {
  const auto vertex_count = static_cast<std::int32_t>(surface.outgoing.size());
  surface.part.assign(vertex_count, kNone);
  surface.part_count = 0;
  std::vector<std::int32_t> pending;
  for (std::int32_t seed = 0; seed < vertex_count; ++seed) {
    if (surface.part[seed] != kNone) continue;
    surface.part[seed] = surface.part_count;
    pending.assign(1, seed);
    while (!pending.empty()) {
      const std::int32_t v = pending.back();
      pending.pop_back();
      const std::int32_t start = surface.outgoing[v];
      std::int32_t h = start;
      while (h != kNone) {
        // Both far corners: at a boundary the last edge of the fan has no half-edge that starts
        // here.
        for (const std::int32_t w : {surface.target(h), surface.origin(prev(h))})
          if (surface.part[w] == kNone) {
            surface.part[w] = surface.part_count;
            pending.push_back(w);
          }
        h = surface.ccw(h);
        if (h == start) break;
      }
    }
    ++surface.part_count;
  }
}

void connect(Surface& surface) {
  choose_outgoing(surface);
  number_parts(surface);
}

double mean_edge_length(const Surface& surface) {
  double sum = 0;
  std::int64_t count = 0;
  const auto face_count = static_cast<std::int32_t>(surface.face_count());
  for (std::int32_t f = 0; f < face_count; ++f)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t h = halfedge(f, i);
      if (surface.twin[h] > h) continue;  // counted from the other side
      const Eigen::Vector3d edge =
          (surface.points[surface.target(h)] - surface.points[surface.origin(h)]).cast<double>();
      sum += edge.norm();
      ++count;
    }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

}  // namespace semigeo::kernels
