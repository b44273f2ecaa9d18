#include "kernels/surface/geodesic_ball.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {
namespace {

/// Returns the distance of the corner at (x, y), y > 0, from a source below the base (0, 0) -
/// (length, 0) that lies `from_first` and `from_second` from its ends. Where the straight line
/// misses the base, the way leads over one of its ends.
double across_face(double from_first, double from_second, double length, double x, double y) {
  const auto norm = [](double a, double b) { return std::sqrt(a * a + b * b); };
  const double around = std::min(from_first + norm(x, y), from_second + norm(x - length, y));
  if (!(length > 0)) return around;
  const double source_x =
      (from_first * from_first - from_second * from_second + length * length) / (2 * length);
  const double below2 = from_first * from_first - source_x * source_x;
  if (!(below2 > 0)) return around;
  const double below = std::sqrt(below2);
  const double crossing = source_x + (x - source_x) * below / (below + y);
  if (!(crossing >= 0 && crossing <= length)) return around;
  return std::min(around, norm(x - source_x, y + below));
}

}  // namespace

void GeodesicBall::start(std::int32_t centre) {
  heap_.clear();
  if (table_.empty()) table_.resize(256);
  if (used_ > 0) std::fill(table_.begin(), table_.end(), Known{});
  used_ = 0;
  offer(centre, 0);
}

GeodesicBall::Known& GeodesicBall::known(std::int32_t vertex) {
  if (2 * used_ >= table_.size()) enlarge();
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (static_cast<std::uint32_t>(vertex) * 2654435769u) & mask;
  while (table_[slot].vertex != kNone && table_[slot].vertex != vertex) slot = (slot + 1) & mask;
  if (table_[slot].vertex == kNone) {
    table_[slot] = {vertex, false, HUGE_VAL};
    ++used_;
  }
  return table_[slot];
}

void GeodesicBall::enlarge() {
  std::vector<Known> old(2 * table_.size());
  old.swap(table_);
  used_ = 0;
  for (const Known& entry : old)
    if (entry.vertex != kNone) known(entry.vertex) = entry;
}

void GeodesicBall::offer(std::int32_t vertex, double distance) {
  Known& entry = known(vertex);
  if (entry.visited || !(distance < entry.distance)) return;
  entry.distance = distance;
  heap_.push_back({distance, vertex});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

bool GeodesicBall::visit_nearest(std::int32_t& vertex, double& distance) {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const Front front = heap_.back();
    heap_.pop_back();
    Known& entry = known(front.vertex);
    if (entry.visited || entry.distance != front.distance) continue;
    entry.visited = true;
    vertex = front.vertex;
    distance = front.distance;
    return true;
  }
  return false;
}

void GeodesicBall::collect_ring(const Connectivity& surface,
                                std::span<const Eigen::Vector4f> points, std::int32_t vertex) {
  ring_.clear();
  const Eigen::Vector3d p = points[vertex].head<3>().cast<double>();
  for (const std::int32_t w : neighbours(surface, vertex)) {
    const Eigen::Vector3d spoke = points[w].head<3>().cast<double>() - p;
    const Known& entry = known(w);
    ring_.push_back({w, entry.visited, entry.distance, spoke.norm(), spoke});
  }
  ring_closed_ = !surface.on_boundary(vertex);
}

void GeodesicBall::expand(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                          std::int32_t vertex, bool is_centre, double radius) {
  const double here = known(vertex).distance;
  collect_ring(surface, points, vertex);
  const auto reach = [&](const Neighbour& to, double distance) {
    if (!to.visited && (is_centre || distance <= radius)) offer(to.vertex, distance);
  };
  for (const Neighbour& to : ring_) reach(to, here + to.length);
  if (is_centre) return;
  // Over each face, from the base between this vertex and a visited one to the third corner.
  const auto cross = [&](const Neighbour& base, const Neighbour& to) {
    if (!base.visited || to.visited || !(base.length > 0)) return;
    const double x = to.spoke.dot(base.spoke) / base.length;
    const double y = std::sqrt(std::max(0.0, to.length * to.length - x * x));
    reach(to, across_face(here, base.distance, base.length, x, y));
  };
  const std::size_t faces = ring_closed_ ? ring_.size() : ring_.size() - 1;
  for (std::size_t i = 0; i < faces; ++i) {
    const Neighbour& a = ring_[i];
    const Neighbour& b = ring_[i + 1 < ring_.size() ? i + 1 : 0];
    cross(a, b);
    cross(b, a);
  }
}

}  // namespace semigeo::kernels
