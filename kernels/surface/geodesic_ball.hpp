#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/surface/circulators.hpp"
#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Finds vertices by their distance along a surface. It keeps its working memory from call to call,
/// so every thread needs one of its own.
///
/// Distances grow vertex by vertex, as in Dijkstra's algorithm. Across a face with two known
/// corners the third is reached on the straight line from a virtual source in the plane of the
/// face. The distances are exact where faces unfold into a plane and none is obtuse; elsewhere they
/// are too long, by one or two per cent in the mean.
class GeodesicBall {
 public:
  /// What the straight line may be longer than the distance that `grow` finds: across bent faces
  /// that is sometimes too short, by two or three per cent.
  static constexpr double kStraightest = 1.05;

  /// Calls visit(vertex, distance) for `centre` and then for every vertex that is not farther than
  /// `radius` (units of the points), the nearest first up to that error, until `visit` returns
  /// false. The neighbours of the centre count as within the radius, however far they are. The cost
  /// is about 0.2 us a vertex.
  template <typename Visit>
  void grow(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
            std::int32_t centre, double radius, const Visit& visit) {
    start(centre);
    std::int32_t vertex = kNone;
    double distance = 0;
    while (visit_nearest(vertex, distance)) {
      if (!visit(vertex, distance)) return;
      expand(surface, points, vertex, distance, vertex == centre, radius);
    }
  }

  /// Calls visit(vertex) for every vertex that `grow` would visit, and for some more: the
  /// neighbours of the centre, and all vertices within `kStraightest` radii in a straight line that
  /// edges between such vertices join to them. Ends when `visit` returns false. The order is
  /// undefined. The cost is a fifth of that of `grow`.
  template <typename Visit>
  void surround(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                std::int32_t centre, double radius, const Visit& visit) {
    const double limit2 = kStraightest * kStraightest * radius * radius;
    start(centre);
    stack_.assign(1, centre);
    const Eigen::Vector4d origin = points[centre].cast<double>();
    while (!stack_.empty()) {
      const std::int32_t vertex = stack_.back();
      stack_.pop_back();
      if (!visit(vertex)) return;
      for (const std::int32_t w : neighbours(surface, vertex)) {
        const double distance2 = (points[w].cast<double>() - origin).squaredNorm();
        if (distance2 > limit2 && vertex != centre) continue;
        const std::size_t known = used_;
        slot_of(w);
        if (used_ == known) continue;
        stack_.push_back(w);
        if (2 * used_ >= table_.size()) enlarge();
      }
    }
  }

 private:
  /// A vertex in the queue.
  struct Front {
    double distance;
    std::int32_t vertex;
    bool operator>(const Front& other) const {
      return distance != other.distance ? distance > other.distance : vertex > other.vertex;
    }
  };
  /// Holds what is known of a vertex. The distance is final when the vertex has been visited.
  struct Known {
    std::int32_t vertex = kNone;
    std::uint32_t ball = 0;  ///< Number of the ball that this entry belongs to; others are free.
    double distance = 0;
    bool visited = false;
  };

  struct Neighbour {
    std::int32_t vertex;
    std::uint32_t slot;  ///< Of what is known of it.
    bool visited;
    double distance;        ///< From the centre; final if visited.
    double length;          ///< Length of the edge to the neighbour.
    Eigen::Vector3d spoke;  ///< From the vertex in the middle to the neighbour.
  };

  void start(std::int32_t centre);
  bool visit_nearest(std::int32_t& vertex, double& distance);
  void collect_ring(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                    std::int32_t vertex);
  void expand(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              std::int32_t vertex, double distance, bool is_centre, double radius);
  std::uint32_t slot_of(std::int32_t vertex);
  void enlarge();
  void offer(std::uint32_t slot, double distance);

  std::vector<Front> heap_;
  std::vector<std::int32_t> stack_;  ///< Of `surround`.
  std::vector<Known> table_;         ///< Hash table with open addressing.
  std::uint32_t ball_ = 0;           ///< Number of the present ball.
  std::size_t used_ = 0;
  std::vector<Neighbour> ring_;  ///< Neighbours of the vertex visited last, anticlockwise.
  bool ring_closed_ = false;
};

}  // namespace semigeo::kernels
