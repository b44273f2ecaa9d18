#include "kernels/patch/geodesic.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/surface/circulators.hpp"

namespace semigeo::kernels {
namespace {

/// The share of its squared size below which a face counts as having no area.
constexpr float kFlatFace = 1e-6f;
constexpr float kTiny = 1e-30f;

/// Holds the scalar products of the edges of a half-edge's frame: e1 along it, e2 to the apex.
struct Metric {
  float e11, e12, e22;
};

Metric metric_of(const GeodesicFace& face, int corner) {
  const int second = corner == 2 ? 0 : corner + 1;
  const int third = corner == 0 ? 2 : corner - 1;
  const float d = face.dot[corner];
  return {d + face.dot[second], d, d + face.dot[third]};
}

/// Returns the same ray in the frame of that half-edge of its face whose apex it approaches
/// fastest. It then leaves the face through one of the two other edges.
Ray towards_apex(const Ray& ray) {
  const float wa = 1 - ray.at.x - ray.at.y;
  const float da = -(ray.dx + ray.dy);
  if (ray.dy >= da && ray.dy >= ray.dx) return ray;
  if (da >= ray.dx) return {{next(ray.at.halfedge), ray.at.y, wa}, ray.dy, da};
  return {{prev(ray.at.halfedge), wa, ray.at.x}, da, ray.dx};
}

}  // namespace

void measure_face(const Connectivity& surface, std::span<const Eigen::Vector4f> points,
                  std::int32_t f, GeodesicFace& face) {
  const auto& t = surface.triangles[f];
  const Eigen::Vector3f p0 = points[t[0]].head<3>();
  const Eigen::Vector3f e01 = points[t[1]].head<3>() - p0;
  const Eigen::Vector3f e02 = points[t[2]].head<3>() - p0;
  const Eigen::Vector3f e12 = e02 - e01;
  face.dot = {e01.dot(e02), -e01.dot(e12), e02.dot(e12)};
  const float size = face.dot[0] + face.dot[1] + face.dot[2];
  face.twice_area = std::max(e01.cross(e02).norm(), kFlatFace * size + kTiny);
  for (int i = 0; i < 3; ++i) face.edge[i] = {0, 0, surface.twin[halfedge(f, i)], t[i]};
}

void unfold_face(std::span<GeodesicFace> faces, std::int32_t f) {
  GeodesicFace& face = faces[f];
  for (int i = 0; i < 3; ++i) {
    GeodesicFace::Edge& edge = face.edge[i];
    if (edge.twin == kNone) continue;
    const GeodesicFace& other = faces[face_of(edge.twin)];
    const int target = i == 2 ? 0 : i + 1;
    const float size = face.dot[0] + face.dot[1] + face.dot[2];
    const float length2 =
        std::max(face.dot[i] + face.dot[target], kFlatFace * kFlatFace * size + kTiny);
    const float height_ratio = face.twice_area / other.twice_area;
    // Theorem 6. Feet of the two apexes on the edge, measured from the twin's origin.
    const float own_foot = face.dot[target];
    const float other_foot = other.dot[corner_of(edge.twin)];
    edge.alpha = (own_foot + height_ratio * other_foot) / length2;
    edge.beta = -height_ratio;
  }
}

Eigen::Vector3f angle_weighted_normal(const Connectivity& surface,
                                      std::span<const Eigen::Vector4f> points, std::int32_t v) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  const Eigen::Vector3f p = points[v].head<3>();
  for (const std::int32_t h : outgoing(surface, v)) {
    const Eigen::Vector3f a = points[surface.target(h)].head<3>() - p;
    const Eigen::Vector3f b = points[surface.origin(prev(h))].head<3>() - p;
    const Eigen::Vector3f cross = a.cross(b);
    const float area = cross.norm();
    if (area > 0) sum += std::atan2(area, a.dot(b)) / area * cross;  // (5.1)
  }
  const float norm = sum.norm();
  return norm > 0 ? Eigen::Vector3f(sum / norm) : Eigen::Vector3f::Zero();
}

Eigen::Vector3f direction_in_space(const GeodesicMesh& mesh, const Ray& ray) {
  const std::int32_t h = ray.at.halfedge;
  const Eigen::Vector3f a = mesh.point(mesh.origin(h));
  const Eigen::Vector3f direction = ray.dx * (mesh.point(mesh.origin(next(h))) - a) +
                                    ray.dy * (mesh.point(mesh.origin(prev(h))) - a);
  const float norm = direction.norm();
  return norm > 0 ? Eigen::Vector3f(direction / norm) : Eigen::Vector3f::Zero();
}

Ray ray_from_vertex(const GeodesicMesh& mesh, std::int32_t v, const Eigen::Vector3f& direction) {
  const Eigen::Vector3f p = mesh.point(v);
  const Eigen::Vector3f& w = mesh.normals[v];
  const Eigen::Vector3f right = direction.cross(w).normalized();
  // Along the tangent plane: over a ridge of 90 degrees or less the way on is not ahead in space.
  const Eigen::Vector3f forward = direction - direction.dot(w) * w;
  Ray best;
  Ray nearest_edge;
  float best_cosine = 0;
  float nearest_cosine = -std::numeric_limits<float>::infinity();
  const std::int32_t start = mesh.outgoing[v];
  std::int32_t h = start;
  Eigen::Vector3f b = mesh.point(mesh.origin(next(h))) - p;
  float side_b = right.dot(b);
  int count = 0;
  do {
    if (++count > kMaxFan) return {};
    const Eigen::Vector3f c = mesh.point(mesh.origin(prev(h))) - p;
    const float side_c = right.dot(c);
    // Anticlockwise the plane's forward half is passed from its right to its left side.
    const float slack = kOnPlane * (std::abs(side_b) + std::abs(side_c) + forward.dot(b + c));
    if (side_b >= -slack && side_c <= slack && side_b > side_c) {
      const float lambda = std::clamp(side_b / (side_b - side_c), 0.0f, 1.0f);
      const Eigen::Vector3f q = b + lambda * (c - b);  // Theorem 7: N(V) meets the opposite edge
      const float length = q.norm();
      const float cosine = forward.dot(q) / length;
      if (cosine > best_cosine && length > 0) {
        best_cosine = cosine;
        best = {{h, 0, 0}, (1 - lambda) / length, lambda / length};
      }
    }
    const float length_b = b.norm();
    if (forward.dot(b) > nearest_cosine * length_b) {
      nearest_cosine = forward.dot(b) / length_b;
      nearest_edge = {{h, 0, 0}, 1 / length_b, 0};
    }
    b = c;
    side_b = side_c;
    h = mesh.twin(prev(h));
  } while (h != kNone && h != start);
  if (best.at.halfedge == kNone && h == start) return nearest_edge;
  return best;
}

Perpendiculars perpendiculars(const GeodesicMesh& mesh, const Ray& ray) {
  const std::int32_t h = ray.at.halfedge;
  const std::array<float, 3> weight = {1 - ray.at.x - ray.at.y, ray.at.x, ray.at.y};
  const std::array<std::int32_t, 3> corner = {h, next(h), prev(h)};
  for (int k = 0; k < 3; ++k)
    if (weight[k] > 1 - kSnap) {
      const std::int32_t v = mesh.origin(corner[k]);
      const Eigen::Vector3f left = mesh.normals[v].cross(direction_in_space(mesh, ray));
      return {ray_from_vertex(mesh, v, left), ray_from_vertex(mesh, v, -left)};
    }
  const GeodesicFace& face = mesh.face(h);
  const Metric m = metric_of(face, corner_of(h));
  // n x d, with n x e1 = (e11 e2 - e12 e1) / |e1 x e2| and n x e2 = (e12 e2 - e22 e1) / |e1 x e2|
  const float dx = -(ray.dx * m.e12 + ray.dy * m.e22) / face.twice_area;
  const float dy = (ray.dx * m.e11 + ray.dy * m.e12) / face.twice_area;
  const float norm2 = dx * dx * m.e11 + 2 * dx * dy * m.e12 + dy * dy * m.e22;
  if (!(norm2 > 0)) return {};
  const float unit = 1 / std::sqrt(norm2);
  const Ray left{ray.at, dx * unit, dy * unit};
  return {left, reversed(left)};
}

GeodesicLine::GeodesicLine(const GeodesicMesh& mesh, const Ray& start) : mesh_(mesh), ray_(start) {
  if (ray_.at.halfedge != kNone) ray_ = towards_apex(ray_);
}

bool GeodesicLine::advance(float length) {
  // In locals, so that one face's result reaches the next face in registers.
  std::int32_t h = ray_.at.halfedge;
  float x = ray_.at.x, y = ray_.at.y, dx = ray_.dx, dy = ray_.dy;
  while (h != kNone) {
    // With the apex to the left of the ray it leaves through target -> apex, else apex -> origin.
    const bool right = dx * (1 - y) + dy * x >= 0;
    const float gap = right ? 1 - x - y : x;  // weight of the corner that is left behind
    const float out = right ? dx + dy : -dx;  // and how fast it falls
    const float in = right ? dx : dy;         // growth of the weight of the twin's target
    if (gap > length * out) {
      ray_ = {{h, x + dx * length, y + dy * length}, dx, dy};
      return true;
    }
    const float distance = std::max(gap, 0.0f) / std::max(out, std::numeric_limits<float>::min());
    length -= distance;
    const float along = (right ? x : y) + in * distance;
    const std::int32_t through = right ? next(h) : prev(h);
    const GeodesicFace::Edge& edge = mesh_.face(through).edge[corner_of(through)];
    if (++crossings_ > mesh_.max_crossings) break;
    if (along < kSnap || along > 1 - kSnap) {
      const std::int32_t vertex = along < kSnap ? mesh_.origin(next(through)) : edge.origin;
      // Theorem 7
      ray_ = ray_from_vertex(mesh_, vertex, direction_in_space(mesh_, {{h, x, y}, dx, dy}));
      h = ray_.at.halfedge;
      x = ray_.at.x;
      y = ray_.at.y;
      dx = ray_.dx;
      dy = ray_.dy;
    } else {
      // Theorem 6: the corner left behind, whose weight falls by `out`, in the neighbour's frame.
      h = edge.twin;
      x = along;
      y = 0;
      dx = in - edge.alpha * out;
      dy = -edge.beta * out;
    }
  }
  ray_.at.halfedge = kNone;
  return false;
}

}  // namespace semigeo::kernels
