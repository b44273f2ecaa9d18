#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

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
      expand(surface, points, vertex, vertex == centre, radius);
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
  /// What is known of a vertex: its distance is final once it has been visited.
  struct Known {
    std::int32_t vertex = kNone;
    bool visited = false;
    double distance = 0;
  };

  struct Neighbour {
    std::int32_t vertex;
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
              std::int32_t vertex, bool is_centre, double radius);
  Known& known(std::int32_t vertex);
  void enlarge();
  void offer(std::int32_t vertex, double distance);

  std::vector<Front> heap_;
  std::vector<Known> table_;  ///< Hash table with open addressing.
  std::size_t used_ = 0;
  std::vector<Neighbour> ring_;  ///< Neighbours of the vertex visited last, anticlockwise.
  bool ring_closed_ = false;
};

}  // namespace semigeo::kernels
