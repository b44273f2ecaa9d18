#include "bench/peers/neighbourhoods.hpp"

#include <algorithm>

#include "kernels/surface/circulators.hpp"

namespace semigeo::peers {

Neighbourhoods::Neighbourhoods(const kernels::Surface& surface)
    : surface_(surface), seen_(surface.points.size(), 0) {}

void Neighbourhoods::start(std::int32_t vertex) {
  ++call_;
  found_.clear();
  take(vertex);
}

/// Adds a vertex that is not there yet.
void Neighbourhoods::take(std::int32_t vertex) {
  if (seen_[vertex] == call_) return;
  seen_[vertex] = call_;
  found_.push_back(vertex);
}

/// Adds the neighbours of all that was found, until there are `least` vertices.
void Neighbourhoods::add_rings(std::size_t least) {
  std::size_t begin = 0;
  while (found_.size() < least && begin < found_.size()) {
    const std::size_t end = found_.size();
    for (; begin < end; ++begin)
      for (const std::int32_t w : kernels::neighbours(surface_, found_[begin])) take(w);
  }
}

std::span<const std::int32_t> Neighbourhoods::rings(std::int32_t vertex, std::size_t least) {
  start(vertex);
  add_rings(least);
  return found_;
}

std::span<const std::int32_t> Neighbourhoods::ball(std::int32_t vertex, double radius,
                                                   std::size_t least) {
  start(vertex);
  const Eigen::Vector3f& centre = surface_.points[vertex];
  const auto limit = static_cast<float>(radius * radius);
  for (std::size_t i = 0; i < found_.size(); ++i)
    for (const std::int32_t w : kernels::neighbours(surface_, found_[i]))
      if ((surface_.points[w] - centre).squaredNorm() <= limit) take(w);
  add_rings(least);
  return found_;
}

std::vector<int> edges_to_boundary(const kernels::Surface& surface, int most) {
  std::vector<int> edges(surface.vertex_count(), most);
  std::vector<std::int32_t> reached;
  for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
    if (surface.on_boundary(v)) {
      edges[v] = 0;
      reached.push_back(v);
    }
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::int32_t w : kernels::neighbours(surface, reached[i]))
      if (edges[w] > edges[reached[i]] + 1) {
        edges[w] = edges[reached[i]] + 1;
        reached.push_back(w);
      }
  return edges;
}

}  // namespace semigeo::peers
