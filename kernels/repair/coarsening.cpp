#include "kernels/repair/coarsening.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// The area of a vertex of an even mesh with edges of length 1.
constexpr double kVertexArea = 0.8660254037844386;
/// The largest area of a vertex that another has joined, in areas of a vertex of an even mesh of
/// the length. With it the mean edge has the length.
constexpr float kMostArea = 1.35F;
/// The longest new edge, in lengths.
constexpr float kLongestEdge = 2.2F;
/// The least cosine between a new face and the normals of its corners.
constexpr float kLeastCosine = 0.5F;
/// The least height of a new face, in its longest sides.
constexpr float kLeastHeight = 0.2F;
/// The distance by which a rim may move where it loses a vertex, in lengths.
constexpr float kRimMove = 0.15F;
/// The number of neighbours beyond which a vertex takes in no other.
constexpr int kMostNeighbours = 16;
/// The cotangents opposite to an edge that is flipped sum to less.
constexpr float kFlipBelow = -0.02F;

/// Coarsens one mesh. A Coarsener is used once.
class Coarsener {
 public:
  Coarsener(LevelMesh& mesh, std::span<const double> lengths)
      : mesh_(mesh), surface_(mesh.connectivity), editor_(mesh.connectivity), lengths_(lengths) {}

  RemeshCounts run() {
    measure_areas();
    merge_all();
    if (counts_.collapsed == 0) return counts_;
    flip_all();
    std::vector<std::int32_t> order;
    order.reserve(editor_.vertex_count());
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(mesh_.vertex_count()); ++v)
      if (editor_.has_vertex(v)) order.push_back(v);
    mesh_.reorder(order);
    return counts_;
  }

 private:
  Vector3f point(std::int32_t v) const { return mesh_.points[v].head<3>(); }
  bool is_left_alone(std::int32_t v) const { return !(lengths_[mesh_.part[v]] > 0); }
  float length_at(std::int32_t v) const { return static_cast<float>(lengths_[mesh_.part[v]]); }

  /// Measures the area of each vertex, in areas of a vertex of the coarse mesh.
  void measure_areas() {
    area_.assign(mesh_.vertex_count(), 0);
    mark_.assign(mesh_.vertex_count(), 0);
    std::vector<float> sixth_per_area(lengths_.size());
    for (std::size_t p = 0; p < lengths_.size(); ++p)
      sixth_per_area[p] =
          static_cast<float>(1 / (6 * kVertexArea * lengths_[p] * lengths_[p]));  // inf for 0
    for (const Triangle& t : surface_.triangles) {
      const Vector3f a = point(t[0]);
      const float sixth = (point(t[1]) - a).cross(point(t[2]) - a).norm();
      const float share = sixth * sixth_per_area[mesh_.part[t[0]]];
      for (const std::int32_t v : t) area_[v] += share;
    }
  }

  /// Merges the vertices with the smallest areas first: in rounds, whose limit doubles.
  void merge_all() {
    float least = kMostArea;
    for (const float area : area_) least = std::min(least, area);
    float limit = kMostArea;
    while (limit > kMostArea / 256 && limit > 2 * least) limit /= 2;
    for (; limit <= kMostArea; limit *= 2) {
      std::vector<std::int32_t> pending;
      for (std::int32_t v = 0; v < static_cast<std::int32_t>(area_.size()); ++v)
        if (area_[v] <= limit / 2) pending.push_back(v);
      std::vector<std::int32_t> next;
      for (; !pending.empty(); pending.swap(next)) {
        next.clear();
        for (const std::int32_t v : pending) {
          if (!editor_.has_vertex(v) || !(area_[v] <= limit / 2)) continue;
          if (const std::int32_t kept = merge(v, limit); kept != kNone) next.push_back(kept);
        }
      }
    }
  }

  struct Partner {
    float length2;
    std::int32_t edge;  ///< A half-edge to or from the partner.
    bool operator<(const Partner& other) const { return length2 < other.length2; }
  };

  /// Merges a vertex with the nearest neighbour with which it may be. Returns what stays of the
  /// two, or kNone.
  std::int32_t merge(std::int32_t v, float limit) {
    partners_.clear();
    const Vector3f p = point(v);
    const float most = limit - area_[v];
    const auto consider = [&](std::int32_t u, std::int32_t edge) {
      if (area_[u] <= most) partners_.push_back({(point(u) - p).squaredNorm(), edge});
    };
    std::int32_t last = kNone;
    int count = 0;
    for (const std::int32_t h : outgoing(surface_, v)) {
      if (++count > kMostNeighbours) return kNone;
      consider(surface_.target(h), h);
      last = h;
    }
    if (surface_.on_boundary(v)) consider(surface_.origin(prev(last)), prev(last));
    std::sort(partners_.begin(), partners_.end());
    for (const Partner& partner : partners_)
      if (const std::int32_t kept = merge_along(partner.edge); kept != kNone) return kept;
    return kNone;
  }

  /// Makes one vertex of the ends of an edge, if it may be. Returns it, or kNone.
  std::int32_t merge_along(std::int32_t h) {
    const std::int32_t t = surface_.twin[h];
    if (t == kNone) return collapse(h);
    const std::int32_t a = surface_.origin(h);
    const std::int32_t b = surface_.target(h);
    const bool a_on_rim = surface_.on_boundary(a);
    const bool b_on_rim = surface_.on_boundary(b);
    if (a_on_rim && b_on_rim) return kNone;
    const bool keep_a = a_on_rim != b_on_rim   ? a_on_rim
                        : area_[a] != area_[b] ? area_[a] > area_[b]
                                               : a < b;
    const std::int32_t kept = collapse(keep_a ? h : t);
    return kept != kNone || a_on_rim || b_on_rim ? kept : collapse(keep_a ? t : h);
  }

  /// Collapses an edge onto the end that the editor lets survive, if it may be. Returns that end,
  /// or kNone.
  std::int32_t collapse(std::int32_t h) {
    const std::int32_t kept = editor_.survivor(h);
    const std::int32_t gone = surface_.origin(h) + surface_.target(h) - kept;
    const bool on_rim = surface_.twin[h] == kNone;
    if (!links_allow(kept, gone, on_rim ? 1 : 2) || (on_rim && !rim_allows(gone)) ||
        !faces_allow(kept, gone))
      return kNone;
    editor_.collapse(h);
    area_[kept] += area_[gone];
    ++counts_.collapsed;
    ++counts_.removed;
    return kept;
  }

  /// Tells whether the ends have only the neighbours in common that the faces of their edge give
  /// them, and whether what stays has neither too many neighbours nor too few for a fan: the last
  /// faces of a part are a tetrahedron or a triangle.
  bool links_allow(std::int32_t kept, std::int32_t gone, int in_common) {
    const int lost = 2 + in_common;  // the ends, and what is counted twice
    const int most = kMostNeighbours + lost;
    const int least = (surface_.on_boundary(kept) ? 2 : 3) + lost;
    ++round_;
    int count = 0;
    for (const std::int32_t v : neighbours(surface_, kept)) {
      if (++count > most) return false;
      mark_[v] = round_;
    }
    int found = 0;
    for (const std::int32_t v : neighbours(surface_, gone)) {
      if (++count > most) return false;
      found += mark_[v] == round_;
    }
    return found == in_common && count >= least;
  }

  /// Tells whether the rim hardly moves without a vertex.
  bool rim_allows(std::int32_t gone) const {
    const std::int32_t first = surface_.outgoing[gone];
    std::int32_t last = first;
    for (const std::int32_t h : outgoing(surface_, gone)) last = h;
    const Vector3f a = point(surface_.target(first));
    const Vector3f b = point(surface_.origin(prev(last)));
    const Vector3f along = b - a;
    const float area = along.cross(point(gone) - a).norm();
    return area <= kRimMove * length_at(gone) * along.norm();
  }

  /// The longest side and twice the area of a face.
  struct Shape {
    float longest2;
    float twice_area;
    float height() const { return twice_area / longest2; }  ///< The least, in longest sides.
  };

  static Shape shape_of(const Vector3f& ab, const Vector3f& ac, const Vector3f& normal) {
    return {std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}), normal.norm()};
  }

  Shape shape_of(std::int32_t a, std::int32_t b, std::int32_t c) const {
    const Vector3f ab = point(b) - point(a);
    const Vector3f ac = point(c) - point(a);
    return shape_of(ab, ac, ab.cross(ac));
  }

  /// Returns the shape of a face that might come to be. Its area counts as zero if it would be
  /// turned from the normals of its corners.
  Shape shape_of_new(std::int32_t a, std::int32_t b, std::int32_t c) const {
    const Vector3f ab = point(b) - point(a);
    const Vector3f ac = point(c) - point(a);
    const Vector3f normal = ab.cross(ac);
    Shape shape = shape_of(ab, ac, normal);
    for (const std::int32_t v : {a, b, c})
      if (!(normal.dot(mesh_.normals[v]) >= kLeastCosine * shape.twice_area)) shape.twice_area = 0;
    return shape;
  }

  /// Tells whether no face round a vertex would turn, become long, or become a needle that it is
  /// not yet, if the vertex joined another.
  bool faces_allow(std::int32_t kept, std::int32_t gone) const {
    const float most = kLongestEdge * length_at(gone);
    for (const std::int32_t h : outgoing(surface_, gone)) {
      const std::int32_t b = surface_.target(h);
      const std::int32_t c = surface_.origin(prev(h));
      if (b == kept || c == kept) continue;
      const Shape shape = shape_of_new(kept, b, c);
      if (!(shape.twice_area > 0) || shape.longest2 > most * most) return false;
      if (shape.height() < kLeastHeight && shape.height() < shape_of(gone, b, c).height())
        return false;
    }
    return true;
  }

  /// Flips edges until the mesh is a Delaunay triangulation, as far as its corners' normals allow.
  void flip_all() {
    std::vector<std::int32_t> pending;
    for (const std::int32_t h : edges(surface_))
      if (!is_left_alone(surface_.origin(h))) pending.push_back(h);
    // On a surface that is not flat, flips may turn in a circle.
    const std::size_t most = 4 * pending.size();
    for (std::size_t i = 0; i < pending.size() && i < most; ++i) {
      if (!is_better_flipped(pending[i])) continue;
      const std::int32_t h = editor_.flip(pending[i]);
      ++counts_.flipped;
      const std::int32_t t = surface_.twin[h];
      for (const std::int32_t side : {next(h), prev(h), next(t), prev(t)}) pending.push_back(side);
    }
  }

  bool is_better_flipped(std::int32_t h) const {
    const std::int32_t t = surface_.twin[h];
    if (t == kNone) return false;
    const std::int32_t a = surface_.origin(h);
    const std::int32_t b = surface_.target(h);
    const std::int32_t c = surface_.origin(prev(h));
    const std::int32_t d = surface_.origin(prev(t));
    const Vector3f ca = point(a) - point(c);
    const Vector3f cb = point(b) - point(c);
    const Vector3f da = point(a) - point(d);
    const Vector3f db = point(b) - point(d);
    const float at_c = ca.dot(cb);
    const float at_d = da.dot(db);
    if (at_c >= 0 && at_d >= 0) return false;
    const float area_c = ca.cross(cb).norm();
    const float area_d = da.cross(db).norm();
    // The sum of the cotangents of the angles at c and d.
    if (!(at_c * area_d + at_d * area_c < kFlipBelow * area_c * area_d)) return false;
    if (!mesh_.face_filled.empty() &&
        mesh_.face_filled[face_of(h)] != mesh_.face_filled[face_of(t)])
      return false;
    for (const Shape& shape : {shape_of_new(a, d, c), shape_of_new(d, b, c)})
      if (!(shape.twice_area > 0 && shape.height() >= kLeastHeight)) return false;
    return editor_.may_flip(h);
  }

  LevelMesh& mesh_;
  const Connectivity& surface_;
  SurfaceEditor editor_;
  std::span<const double> lengths_;
  std::vector<float> area_;         ///< (N) In areas of a vertex of the coarse mesh.
  std::vector<std::int32_t> mark_;  ///< (N) The round in which a vertex was marked.
  std::int32_t round_ = 0;
  std::vector<Partner> partners_;
  RemeshCounts counts_;
};

}  // namespace

RemeshCounts coarsen(LevelMesh& mesh, std::span<const double> lengths) {
  return Coarsener(mesh, lengths).run();
}

}  // namespace semigeo::kernels
