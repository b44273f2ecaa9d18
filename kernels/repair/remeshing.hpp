#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/repair/remesh_counts.hpp"
#include "kernels/surface/connectivity.hpp"
#include "kernels/surface/surface_editor.hpp"

namespace semigeo::kernels {

/// A surface on its way through the levels, with all that its vertices carry along.
struct LevelMesh {
  Connectivity connectivity;
  std::vector<std::int32_t> part;  ///< (N) connected part, numbered by first vertex
  std::int32_t part_count = 0;
  std::vector<Eigen::Vector4f> points;          ///< (N) fourth component 0
  std::vector<Eigen::Vector3f> normals;         ///< (N) unit, or zero
  std::vector<std::int32_t> source;             ///< (N) vertex of level 0, or kNone: inserted
  std::vector<Eigen::Vector3f> initial_points;  ///< (N) where on level 0: at `source`, or between
                                                ///< those of the ends of the edge that was halved
  std::vector<std::uint8_t> vertex_filled;      ///< (N) 1 = made by filling a hole; or empty
  std::vector<std::uint8_t> face_filled;        ///< (F)

  std::int64_t vertex_count() const { return static_cast<std::int64_t>(points.size()); }
  Eigen::Vector3d point(std::int32_t v) const { return points[v].head<3>().cast<double>(); }
  /// Of a half-edge, squared.
  double length2(std::int32_t h) const {
    return (point(connectivity.target(h)) - point(connectivity.origin(h))).squaredNorm();
  }
  /// Least height of a face, squared.
  double height2(std::int32_t f) const;
};

/// Appends those faces of [begin, end) that have a side or a height shorter than `length`.
void find_odd_faces(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                    std::vector<std::int32_t>& faces);
/// Appends those edges of faces [begin, end) that are longer than `length`, each once, as
/// half-edges.
void find_long_edges(const LevelMesh& mesh, std::int32_t begin, std::int32_t end, double length,
                     std::vector<std::int32_t>& edges);

/// Rids a mesh of odd triangles. Serial; the cost is that of what is found and of a few linear
/// passes in `finish`. The result depends on the mesh alone, and is a surface with all that
/// kernels/surface/connectivity.hpp promises.
/// Source: thesis 5.5, 6.1.1. Differs: the thesis looks at the shortest side only, which passes
/// over triangles whose corners lie on a line, and removes odd triangles by a decimation that is
/// not described. Here flat ones are flipped away or collapsed, short sides collapsed, and where
/// that would pinch the surface it is cut and covered.
class Remesher {
 public:
  /// The mesh must outlive the remesher; until `finish` its arrays have gaps. `curved`: new
  /// vertices lie on the curved surface over their edge, else on the edge.
  Remesher(LevelMesh& mesh, bool curved);

  /// Removes the part of a face.
  void drop_part(std::int32_t face);

  /// Removes all triangles with a side or a height below `shortest`; `faces` must name them all.
  /// Short sides are collapsed, the shortest first. Then a flat triangle has its longest side
  /// flipped, if that makes the lesser height of the two faces greater, or its shortest collapsed.
  /// Where an edge closes a neck or a handle (three edges that bound no face), that is cut through
  /// and both ends are covered; a strip is cut; a triangle or a tetrahedron is
  /// dropped. The last one stays, made regular with sides of 10 `shortest`: there is always a
  /// surface.
  void remove_odd(std::span<const std::int32_t> faces, double shortest);

  /// Halves edges longer than `longest`, the longest first, until there are `faces` faces or
  /// no such edge is left. No new side or height becomes shorter than `shortest`.
  void refine(std::span<const std::int32_t> edges, std::int64_t faces, double longest,
              double shortest);

  std::int64_t face_count() const { return editor_.face_count(); }
  const RemeshCounts& counts() const { return counts_; }
  /// The surface has vanished but for the mark that `remove_odd` leaves; it is not refined.
  bool vanished() const { return vanished_; }

  /// Closes all gaps. New vertices come next to those they come from, every part is one range
  /// of vertices and one of faces, and parts are numbered in that order.
  RemeshCounts finish();

 private:
  /// An edge by its squared length, or a face by its squared least height.
  struct Entry {
    double measure;
    std::int32_t index;
    bool operator<(const Entry& other) const {
      return measure != other.measure ? measure < other.measure : index < other.index;
    }
    bool operator>(const Entry& other) const { return other < *this; }
  };
  /// Smallest or largest first. An entry whose edge or face has changed since is void: what
  /// changes is put on the heap again.
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
  void mark_face(std::int32_t f, std::uint8_t filled);
  bool split(std::int32_t h, double shortest);
  std::vector<std::int32_t> order_of_survivors();
  void reorder(const std::vector<std::int32_t>& order);

  LevelMesh& mesh_;
  SurfaceEditor editor_;
  bool curved_;
  bool parts_changed_ = false;
  bool vanished_ = false;
  std::int64_t first_new_;  ///< vertices from here on were made by editing
  RemeshCounts counts_;
  double shortest2_ = 0;  ///< squared threshold of `remove_odd`
  Heap edges_;
  Heap faces_;
};

}  // namespace semigeo::kernels
