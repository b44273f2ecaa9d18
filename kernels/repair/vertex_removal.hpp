#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/repair/loop_split.hpp"
#include "kernels/surface/surface.hpp"
#include "kernels/surface/surface_editor.hpp"

namespace semigeo::kernels {

/// A surface that loses vertices, one at a time: the fan of faces round a vertex is replaced by a
/// split of the loop of its neighbours. Vertices and faces keep their numbers until `compacted`.
class ThinningSurface {
 public:
  /// The surface must outlive the object.
  explicit ThinningSurface(const Surface& surface);
  ThinningSurface(const ThinningSurface&) = delete;
  ThinningSurface& operator=(const ThinningSurface&) = delete;

  /// The surroundings of a vertex.
  struct Region {
    std::int32_t vertex = kNone;
    bool closed = false;               ///< Whether the vertex is not on a boundary.
    std::vector<std::int32_t> spokes;  ///< Half-edges that leave the vertex, anticlockwise.
    std::vector<std::int32_t> ring;    ///< Neighbours, anticlockwise; ring[k] ends spokes[k].
    Eigen::Vector3d normal;            ///< Twice the vector area of the fan.
    double reach = 0;                  ///< Mean length of the edges to the ring.
    /// Distance of the vertex from the average plane of the ring, or on a boundary from the line
    /// between its two neighbours there.
    double distance = 0;
  };

  /// Fills `region` with the surroundings of a vertex.
  void examine(std::int32_t vertex, Region& region) const;

  /// Returns the triangles (of vertices) that would cover the region without its vertex; none if
  /// there is no valid cover. The result is valid until the next call.
  std::span<const Triangle> cover(const Region& region);

  /// Removes the vertex of a region and puts the cover there: its triangle k becomes the face of
  /// spokes[k].
  void replace(const Region& region, std::span<const Triangle> cover) {
    editor_.remove_vertex(region.vertex, cover);
  }

  const Eigen::Vector3f& point(std::int32_t vertex) const { return points_[vertex]; }

  /// Returns what is left, in the old order; `source_vertex` takes the old index of each vertex.
  Surface compacted(std::vector<std::int32_t>& source_vertex) const;

 private:
  Eigen::Vector3d normal(const Triangle& t) const;
  bool joined(std::int32_t a, std::int32_t b) const;
  bool is_removable(const Region& region) const;
  bool faces_keep_direction(const Region& region) const;

  const std::vector<Eigen::Vector3f>& points_;
  Connectivity mesh_;
  SurfaceEditor editor_;
  LoopSplitter splitter_;
  std::vector<Eigen::Vector3d> loop_;
  std::vector<Triangle> cover_;
};

}  // namespace semigeo::kernels
