#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "kernels/repair/remesh_counts.hpp"
#include "kernels/surface/connectivity.hpp"
#include "kernels/surface/surface_editor.hpp"

namespace semigeo::kernels {

/// Holds a surface on its way through the levels, with all that its vertices carry along.
struct LevelMesh {
  Connectivity connectivity;
  std::vector<std::int32_t> part;  ///< (N) Connected part, numbered by first vertex.
  std::int32_t part_count = 0;
  std::vector<Eigen::Vector4f> points;          ///< (N) The fourth component is 0.
  std::vector<Eigen::Vector3f> normals;         ///< (N) Of unit length, or zero.
  std::vector<std::int32_t> source;             ///< (N) Vertex of level 0; kNone if inserted.
  std::vector<Eigen::Vector3f> initial_points;  ///< (N) Place on level 0: at `source`, or in the
                                                ///< middle of those of the halved edge.
  std::vector<std::uint8_t> vertex_filled;      ///< (N) 1 where filling a hole made it; or empty.
  std::vector<std::uint8_t> face_filled;        ///< (F) 1 where filling a hole made it; or empty.

  /// Returns all arrays that have a row for each vertex.
  auto vertex_rows() {
    return std::tie(points, normals, source, initial_points, part, vertex_filled);
  }
  std::int64_t vertex_count() const { return static_cast<std::int64_t>(points.size()); }
  Eigen::Vector3d point(std::int32_t v) const { return points[v].head<3>().cast<double>(); }
  /// Returns the squared length of a half-edge.
  double length2(std::int32_t h) const {
    return (point(connectivity.target(h)) - point(connectivity.origin(h))).squaredNorm();
  }
  /// Returns the squared least height of a face.
  double height2(std::int32_t f) const;
  /// Puts the vertices into another order, as `kernels::reordered` does, with all that they carry.
  /// Vertices without faces may be left out.
  void reorder(const std::vector<std::int32_t>& order);
};

/// Finds odd triangles: appends those faces of [begin, end) that have a side or a height shorter
/// than `length`.
void find_odd_faces(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                    std::vector<std::int32_t>& faces);
/// Appends those edges of faces [begin, end) that are longer than `length`, each once, as
/// half-edges.
void find_long_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                     std::vector<std::int32_t>& edges);

/// Rids a mesh of odd triangles. It is serial; the cost is that of what is found and of a few
/// linear passes in `finish`. The result depends on the mesh alone, and keeps all that
/// kernels/surface/connectivity.hpp promises. Source: thesis 5.5, 6.1.1.
///
/// Differs: the thesis looks at the shortest side only, which passes over triangles whose corners
/// lie on a line, and removes odd triangles by a decimation that is not described. Here flat
/// triangles are flipped away or collapsed, short sides are collapsed, and where that would pinch
/// the surface it is cut and covered.
class Remesher {
 public:
  /// Starts editing. The mesh must outlive the remesher; until `finish` its arrays have gaps. With
  /// `curved`, new vertices lie on the curved surface over their edge, without it on the edge.
  Remesher(LevelMesh& mesh, bool curved);

  /// Removes the connected part of a face.
  void drop_part(std::int32_t face);

  /// Removes all triangles with a side or a height below `shortest`; `faces` must name them all.
  /// Short sides are collapsed, the shortest first. Then a flat triangle has its longest side
  /// flipped, if that makes the lesser height of the two faces greater; otherwise its shortest side
  /// is collapsed. Where an edge closes a neck or a handle (three edges that bound no face), the
  /// neck is cut through and both ends are covered; a strip is cut; a part that is one triangle or
  /// one tetrahedron is dropped. The last such part stays, made regular with sides of 10
  /// `shortest`, so that there is always a surface.
  void remove_odd(std::span<const std::int32_t> faces, double shortest);

  /// Halves those of `edges` and of new edges that are longer than `longest`, the longest first,
  /// until there are `faces` faces or no such edge is left. No new side or height becomes shorter
  /// than `shortest`.
  void refine(std::span<const std::int32_t> edges, std::int64_t faces, double longest,
              double shortest);

  std::int64_t face_count() const { return editor_.face_count(); }
  const RemeshCounts& counts() const { return counts_; }
  /// Tells whether the surface has vanished except for the part that `remove_odd` leaves; it is not
  /// refined any more.
  bool vanished() const { return vanished_; }

  /// Closes all gaps. New vertices are put behind those that they come from, every part becomes one
  /// range of vertices and one of faces, and parts are numbered in that order.
  RemeshCounts finish();

 private:
  /// An edge with its squared length, or a face with its squared least height.
  struct Entry {
    double measure;
    std::int32_t index;
    bool operator<(const Entry& other) const {
      return measure != other.measure ? measure < other.measure : index < other.index;
    }
    bool operator>(const Entry& other) const { return other < *this; }
  };
  /// A heap with the smallest or the largest entry first. An entry whose edge or face has changed
  /// since is void: what changes is put on the heap again.
  using Heap = std::vector<Entry>;

  void remove_short_edges();
  void remove_flat_face(std::int32_t f);
  void remove_edge(std::int32_t h);
  bool keep_remnant(std::int32_t h);
  bool flip_is_better(std::int32_t h) const;
  void merge(std::int32_t h);
  void absorb(std::int32_t h);
  void carry_over(std::int32_t a, std::int32_t b);
  std::int32_t spoke_inside(std::int32_t h, std::int32_t third) const;
  Eigen::Vector3d merged_point(std::int32_t a, std::int32_t b) const;
  double least_cosine(std::int32_t v, std::int32_t other, const Eigen::Vector3d& p) const;
  void push_edge(std::int32_t h);
  void push_face(std::int32_t f);
  void push_fan(std::int32_t v);
  Eigen::Vector3f middle(std::int32_t a, std::int32_t b) const;
  void carry_new_vertices();
  void put_between(std::int32_t a, std::int32_t b);
  void mark_face(std::int32_t f, std::uint8_t filled);
  bool split(std::int32_t h, double shortest);
  std::vector<std::int32_t> order_of_survivors();

  LevelMesh& mesh_;
  SurfaceEditor editor_;
  bool curved_;
  bool parts_changed_ = false;
  bool vanished_ = false;
  std::int64_t first_new_;  ///< Vertices from here on were made by editing.
  RemeshCounts counts_;
  double shortest2_ = 0;  ///< Squared threshold of `remove_odd`.
  Heap edges_;
  Heap faces_;
};

}  // namespace semigeo::kernels
