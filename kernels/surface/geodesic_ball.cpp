#include "kernels/surface/geodesic_ball.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {
namespace {

/// Returns the distance of the corner (x, y), y > 0, from a source below the base, which runs from
/// (0, 0) to (length, 0). The source has the distances `from_first` and `from_second` from the ends
/// of the base. If the straight line misses the base, the path leads over one of its ends.
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
  if (++ball_ == 0) {  // all numbers were used once
    std::fill(table_.begin(), table_.end(), Known{});
    ball_ = 1;
  }
  used_ = 0;
  offer(slot_of(centre), 0);
}

/// Returns where the vertex is in the table, and enters it if need be.
std::uint32_t GeodesicBall::slot_of(std::int32_t vertex) {
  const auto mask = static_cast<std::uint32_t>(table_.size() - 1);
  std::uint32_t slot = (static_cast<std::uint32_t>(vertex) * 2654435769u) & mask;
  while (table_[slot].ball == ball_ && table_[slot].vertex != vertex) slot = (slot + 1) & mask;
  if (table_[slot].ball != ball_) {
    table_[slot] = {vertex, ball_, HUGE_VAL, false};
    ++used_;
  }
  return slot;
}

void GeodesicBall::enlarge() {
  std::vector<Known> old(2 * table_.size());
  old.swap(table_);
  used_ = 0;
  for (const Known& entry : old)
    if (entry.ball == ball_) table_[slot_of(entry.vertex)] = entry;
}

void GeodesicBall::offer(std::uint32_t slot, double distance) {
  Known& entry = table_[slot];
  if (entry.visited || !(distance < entry.distance)) return;
  entry.distance = distance;
  heap_.push_back({distance, entry.vertex});
  std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
}

bool GeodesicBall::visit_nearest(std::int32_t& vertex, double& distance) {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const Front front = heap_.back();
    heap_.pop_back();
    Known& entry = table_[slot_of(front.vertex)];
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
    ring_.push_back({w, 0, false, 0, spoke.norm(), spoke});
  }
  while (2 * (used_ + ring_.size()) >= table_.size()) enlarge();
  for (Neighbour& to : ring_) {
    to.slot = slot_of(to.vertex);
    to.visited = table_[to.slot].visited;
    to.distance = table_[to.slot].distance;
  }
  ring_closed_ = !surface.on_boundary(vertex);
}

void GeodesicBall::expand(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                          std::int32_t vertex, double distance, bool is_centre, double radius) {
  collect_ring(surface, points, vertex);
  const auto reach = [&](const Neighbour& to, double from_centre) {
    if (!to.visited && (is_centre || from_centre <= radius)) offer(to.slot, from_centre);
  };
  for (const Neighbour& to : ring_) reach(to, distance + to.length);
  if (is_centre) return;
  // Distances are carried over each face, from a base between this vertex and a visited one to the
  // third corner.
  const auto cross = [&](const Neighbour& base, const Neighbour& to) {
    if (!base.visited || to.visited || !(base.length > 0)) return;
    const double x = to.spoke.dot(base.spoke) / base.length;
    const double y = std::sqrt(std::max(0.0, to.length * to.length - x * x));
    reach(to, across_face(distance, base.distance, base.length, x, y));
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
