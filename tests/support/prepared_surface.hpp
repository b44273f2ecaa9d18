#pragma once

#include <utility>
#include <vector>

#include "kernels/evolution/evolution.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/vertex_order.hpp"

namespace semigeo::kernels {

/// A triangle mesh made ready for patches on one thread: what the surface job does, without jobs.
struct PreparedSurface {
  explicit PreparedSurface(TriangleMesh mesh, bool sample_curved = true) : curved(sample_curved) {
    const Surface built = build_surface(std::move(mesh)).surface;
    surface = reordered(built, locality_order(built));
    for (const auto& p : surface.points) points.emplace_back(p.x(), p.y(), p.z(), 0.0f);
    normals.resize(points.size());
    for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
      normals[v] = angle_weighted_normal(surface, points, v);
    prepare();
  }

  void prepare() {
    faces.resize(surface.face_count());
    faces_curved.resize(surface.face_count() + 1);
    for (std::int32_t f = 0; f < surface.face_count(); ++f)
      measure_face(surface, points, f, faces[f]);
    for (std::int32_t f = 0; f < surface.face_count(); ++f) {
      unfold_face(faces, f);
      for (int i = 0; i < 3; ++i) {
        const auto a = surface.triangles[f][i], b = surface.triangles[f][(i + 1) % 3];
        faces_curved[f].bulge[i] =
            edge_bulge(points[a].head<3>(), points[b].head<3>(), normals[a], normals[b]);
      }
    }
  }

  /// Replaces the normals by those of the convolved surface, as level 0 does.
  void sharpen_normals(float step) {
    std::vector<Eigen::Vector3f> sharp(normals.size());
    for (std::int32_t v = 0; v < surface.vertex_count(); ++v)
      sharp[v] = evolve_vertex(sampled(), v, {.step = step}).normal;
    normals = std::move(sharp);
    prepare();
  }

  SampledSurface sampled() const {
    if (!curved) return {{faces, surface.outgoing, points, normals}, {}};
    return {{faces, surface.outgoing, points, normals}, faces_curved};
  }
  GeodesicMesh mesh() const { return sampled().mesh; }

  /// The vertex nearest to a point.
  std::int32_t nearest(const Eigen::Vector3f& p) const {
    std::int32_t best = 0;
    for (std::int32_t v = 1; v < surface.vertex_count(); ++v)
      if ((points[v].head<3>() - p).norm() < (points[best].head<3>() - p).norm()) best = v;
    return best;
  }
  /// Where a face point lies on the flat faces.
  Eigen::Vector3f position(const FacePoint& at) const {
    const auto& t = surface.triangles[face_of(at.halfedge)];
    const int i = corner_of(at.halfedge);
    const Eigen::Vector3f a = points[t[i]].head<3>(), b = points[t[(i + 1) % 3]].head<3>(),
                          c = points[t[(i + 2) % 3]].head<3>();
    return a + at.x * (b - a) + at.y * (c - a);
  }

  bool curved;
  Surface surface;
  std::vector<Eigen::Vector4f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<GeodesicFace> faces;
  std::vector<QuadraticFace> faces_curved;
};

}  // namespace semigeo::kernels
