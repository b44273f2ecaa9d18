#include "bench/support/isotropic_remeshing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "bench/support/edit_mesh.hpp"
#include "bench/support/mesh_changes.hpp"
#include "kernels/surface/nearest_surface.hpp"

namespace semigeo::bench {
namespace {

using Vertex = EditMesh::VertexHandle;
using Halfedge = EditMesh::HalfedgeHandle;
using Edge = EditMesh::EdgeHandle;

constexpr int kRounds = 10;
// Edges are split above and collapsed below these multiples of the wanted length. Halves of a split
// edge are not collapsed again.
constexpr double kLongest = 4.0 / 3;
constexpr double kShortest = 4.0 / 5;
/// The cosine of the greatest angle by which a face may turn in a collapse or a flip.
constexpr double kMaxTurn = 0.5;

class IsotropicRemesher {
 public:
  explicit IsotropicRemesher(const kernels::Surface& surface)
      : mesh_(edit_mesh(triangle_mesh(surface))), nearest_(surface) {}

  kernels::TriangleMesh remeshed(std::int64_t vertices) {
    double area = 0;
    for (const auto f : mesh_.faces()) area += mesh_.calc_sector_area(mesh_.halfedge_handle(f));
    // There are two equilateral triangles for each vertex.
    double length = std::sqrt(2 * area / (std::sqrt(3.0) * static_cast<double>(vertices)));
    for (int round = 0; round < kRounds; ++round) {
      split_longer_than(kLongest * length);
      collapse_shorter_than(kShortest * length, kLongest * length);
      mesh_.garbage_collection();
      flip();
      relax();
      length *= std::sqrt(static_cast<double>(mesh_.n_vertices()) / static_cast<double>(vertices));
    }
    return triangle_mesh(mesh_);
  }

 private:
  Eigen::Vector3d point(Vertex v) const { return eigen(mesh_.point(v)); }
  double length(Edge e) const { return mesh_.calc_edge_length(e); }

  /// Splits long edges, longer ones roughly first, because splitting a short side of a triangle
  /// makes another long edge. New edges come last, and are split as well if they are long.
  void split_longer_than(double longest) {
    double bound = 0;
    for (const auto e : mesh_.edges()) bound = std::max(bound, length(e));
    while (bound > longest) {
      bound = std::max(bound / std::numbers::sqrt2, longest);
      for (std::size_t e = 0; e < mesh_.n_edges(); ++e) {
        const Edge edge = mesh_.edge_handle(static_cast<unsigned>(e));
        if (length(edge) > bound) mesh_.split(edge, mesh_.calc_edge_midpoint(edge));
      }
    }
  }

  void collapse_shorter_than(double shortest, double longest) {
    for (std::size_t e = 0; e < mesh_.n_edges(); ++e) {
      const Edge edge = mesh_.edge_handle(static_cast<unsigned>(e));
      if (mesh_.status(edge).deleted() || length(edge) >= shortest) continue;
      const Halfedge h = mesh_.halfedge_handle(edge, 0);
      const Vertex from = mesh_.from_vertex_handle(h);
      const Vertex to = mesh_.to_vertex_handle(h);
      if (mesh_.is_boundary(from) || mesh_.is_boundary(to) || !mesh_.is_collapse_ok(h)) continue;
      const Eigen::Vector3d middle = (point(from) + point(to)) / 2;
      if (!may_move(from, to, middle, longest) || !may_move(to, from, middle, longest)) continue;
      mesh_.collapse(h);
      mesh_.set_point(to, open_mesh(middle));
    }
  }

  /// Returns whether a vertex may move there without making a long edge or turning a face. Faces
  /// with `partner`, with which it will be merged, are left out, because they vanish.
  bool may_move(Vertex v, Vertex partner, const Eigen::Vector3d& there, double longest) const {
    for (const auto h : mesh_.voh_range(v)) {
      const Vertex a = mesh_.to_vertex_handle(h);
      const Vertex b = mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h));
      if (a != partner && (point(a) - there).norm() > longest) return false;
      if (a == partner || b == partner || mesh_.is_boundary(h)) continue;
      if (turns(normal(point(v), point(a), point(b)), normal(there, point(a), point(b))))
        return false;
    }
    return true;
  }

  static Eigen::Vector3d normal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
    return (b - a).cross(c - a);
  }
  static bool turns(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
    return after.dot(before) <= kMaxTurn * after.norm() * before.norm();
  }

  void flip() {
    for (const auto e : mesh_.edges()) {
      if (mesh_.is_boundary(e) || !mesh_.is_flip_ok(e)) continue;
      const Halfedge h = mesh_.halfedge_handle(e, 0);
      const Halfedge g = mesh_.opposite_halfedge_handle(h);
      const std::array<Vertex, 2> ends = {mesh_.from_vertex_handle(h), mesh_.to_vertex_handle(h)};
      const std::array<Vertex, 2> far = {mesh_.opposite_vh(h), mesh_.opposite_vh(g)};
      int gain = 0;
      for (const Vertex v : ends) gain += excess(v, 0) - excess(v, -1);
      for (const Vertex v : far) gain += excess(v, 0) - excess(v, 1);
      if (gain <= 0) continue;
      const Eigen::Vector3d before = normal(point(ends[0]), point(ends[1]), point(far[0])) +
                                     normal(point(ends[1]), point(ends[0]), point(far[1]));
      if (turns(before, normal(point(far[0]), point(ends[0]), point(far[1]))) ||
          turns(before, normal(point(far[1]), point(ends[1]), point(far[0]))))
        continue;
      mesh_.flip(e);
    }
  }

  /// Returns how far the number of edges of a vertex is from six, or from four on a boundary, with
  /// this number of edges more.
  int excess(Vertex v, int more) const {
    return std::abs(static_cast<int>(mesh_.valence(v)) + more - (mesh_.is_boundary(v) ? 4 : 6));
  }

  /// Moves all vertices at once, and then each of them onto the surface.
  void relax() {
    std::vector<Eigen::Vector3d> moved(mesh_.n_vertices());
    for (const auto v : mesh_.vertices()) {
      moved[v.idx()] = point(v);
      if (mesh_.is_boundary(v)) continue;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Vector3d up = Eigen::Vector3d::Zero();
      for (const auto h : mesh_.voh_range(v)) {
        const Eigen::Vector3d a = point(mesh_.to_vertex_handle(h));
        sum += a;
        up += normal(point(v), a, point(mesh_.to_vertex_handle(mesh_.next_halfedge_handle(h))));
      }
      const Eigen::Vector3d step = sum / static_cast<double>(mesh_.valence(v)) - point(v);
      up.normalize();
      moved[v.idx()] = nearest_.nearest(point(v) + step - step.dot(up) * up).point;
    }
    for (const auto v : mesh_.vertices()) mesh_.set_point(v, open_mesh(moved[v.idx()]));
  }

  EditMesh mesh_;
  kernels::NearestSurface nearest_;
};

}  // namespace

kernels::TriangleMesh isotropic_remeshed(const kernels::Surface& surface, std::int64_t vertices) {
  return IsotropicRemesher(surface).remeshed(vertices);
}

}  // namespace semigeo::bench
