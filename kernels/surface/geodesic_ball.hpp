#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"

namespace semigeo::kernels {

/// Finds vertices by their distance along a surface. Keeps its working memory from call to call;
/// one for each thread.
///
/// Distances grow front by front, as in Dijkstra's algorithm; across a face with two known corners
/// the third is reached on the straight line from a virtual source in the face's plane. Exact where
/// faces unfold into a plane and none is obtuse; else too long by one or two per cent in the mean.
class GeodesicBall {
 public:
  /// Calls visit(vertex, distance) for `centre` and then for every vertex that is not farther than
  /// `radius`, nearest first but for that error, until it returns false. The ring of neighbours of
  /// the centre counts as within the radius, however far. Cost: about 0.2 us a vertex.
  template <typename Visit>
  void grow(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
            std::int32_t centre, double radius, const Visit& visit) {
    start(centre);
    std::int32_t vertex = kNone;
    double distance = 0;
    while (settle_next(vertex, distance)) {
      if (!visit(vertex, distance)) return;
      spread(surface, points, vertex, vertex == centre, radius);
    }
  }

 private:
  struct Front {
    double distance;
    std::int32_t vertex;
    bool operator>(const Front& other) const {
      return distance != other.distance ? distance > other.distance : vertex > other.vertex;
    }
  };
  struct Known {
    std::int32_t vertex = kNone;
    bool settled = false;
    double distance = 0;
  };

  struct Neighbour {
    std::int32_t vertex;
    bool settled;
    double distance;        ///< from the centre, if settled
    double length;          ///< of the spoke
    Eigen::Vector3d spoke;  ///< from the vertex in the middle
  };

  void start(std::int32_t centre);
  bool settle_next(std::int32_t& vertex, double& distance);
  void look_round(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                  std::int32_t vertex);
  void spread(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
              std::int32_t vertex, bool is_centre, double radius);
  Known& known(std::int32_t vertex);
  void enlarge();
  void offer(std::int32_t vertex, double distance);

  std::vector<Front> heap_;
  std::vector<Known> table_;  ///< hash table, open addressing
  std::size_t used_ = 0;
  std::vector<Neighbour> ring_;  ///< of the vertex settled last, anticlockwise
  bool ring_closed_ = false;
};

}  // namespace semigeo::kernels
