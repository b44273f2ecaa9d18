#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/repair/loop_split.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::kernels {

/// A surface that loses vertices, one at a time: the fan of faces round a vertex is replaced by a
/// split of the loop of its neighbours. Faces keep their slots in the arrays; free ones stay behind
/// until `compacted`.
class ThinningSurface {
 public:
  explicit ThinningSurface(const Surface& surface);

  /// The surroundings of a vertex.
  struct Region {
    std::int32_t vertex = kNone;
    bool closed = false;                ///< the vertex is not on a boundary
    std::vector<std::int32_t> ring;     ///< neighbours, anticlockwise
    std::vector<std::int32_t> faces;    ///< the fan: (vertex, ring[k], ring[k + 1])
    std::vector<std::int32_t> outside;  ///< the half-edge across ring[k], ring[k + 1], or kNone
    Eigen::Vector3d normal;             ///< twice the vector area of the fan
    double reach = 0;                   ///< mean length of the edges to the ring
    double distance = 0;  ///< of the vertex from the region's average plane or boundary line
  };

  void look_at(std::int32_t vertex, Region& region) const;

  /// The triangles (of vertices) that would cover the region without its vertex; empty if there is
  /// no valid cover. Valid until the next call.
  std::span<const std::array<std::int32_t, 3>> cover(const Region& region);

  /// Puts the cover in place of the fan. result: the slots of its faces, in order.
  std::span<const std::int32_t> replace(const Region& region,
                                        std::span<const std::array<std::int32_t, 3>> cover);

  const Eigen::Vector3f& point(std::int32_t vertex) const { return points_[vertex]; }
  const std::array<std::int32_t, 3>& face(std::int32_t f) const { return triangles_[f]; }

  /// What is left, in order; `source_vertex` takes the old index of each vertex.
  Surface compacted(std::vector<std::int32_t>& source_vertex) const;

 private:
  std::int32_t origin(std::int32_t h) const { return triangles_[face_of(h)][corner_of(h)]; }
  Eigen::Vector3d normal(const std::array<std::int32_t, 3>& t) const;
  bool joined(std::int32_t a, std::int32_t b) const;
  bool may_go(const Region& region) const;
  bool turns_little(const Region& region) const;
  void link_faces(const Region& region, std::span<const std::array<std::int32_t, 3>> cover);

  const std::vector<Eigen::Vector3f>& points_;
  std::vector<std::array<std::int32_t, 3>> triangles_;  ///< first corner kNone: a free slot
  std::vector<std::int32_t> twin_;
  std::vector<std::int32_t> outgoing_;  ///< kNone: removed
  LoopSplitter splitter_;
  std::vector<Eigen::Vector3d> loop_;
  std::vector<std::array<std::int32_t, 3>> cover_;
};

}  // namespace semigeo::kernels
