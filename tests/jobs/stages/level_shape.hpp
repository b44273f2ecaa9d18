#pragma once

#include <Eigen/Geometry>
#include <map>
#include <utility>
#include <vector>

#include "tests/jobs/stages/evolve_mesh.hpp"

namespace semigeo::jobs {

/// Geometry and connectivity of one level, in the scan's coordinates.
struct LevelShape {
  kernels::TriangleMesh mesh;
  std::vector<std::int32_t> source;  ///< (N) vertex of level 0, -1 = inserted
  std::vector<std::int32_t> part;    ///< (N)
  std::int64_t parts = 0;

  std::int32_t part_of(const std::array<std::int32_t, 3>& triangle) const {
    return part[triangle[0]];
  }
};

/// Every level with the connectivity that it has, or shares with the levels before.
inline std::vector<LevelShape> level_shapes(const EvolvedMesh& evolved) {
  std::vector<LevelShape> shapes;
  LevelShape shape{{{}, evolved.surface.triangles}, {}, evolved.surface.part, 0};
  for (std::int32_t v = 0; v < evolved.surface.vertex_count(); ++v) shape.source.push_back(v);
  for (std::size_t k = 0; k < evolved.levels.size(); ++k) {
    const LevelFields& level = evolved.levels[k];
    if (level.connectivity) {
      shape.mesh.triangles = level.connectivity->triangles;
      shape.source = level.connectivity->source_vertex;
      shape.part = level.connectivity->part;
    }
    shape.parts = level.parts;
    shape.mesh.points.clear();
    for (std::size_t v = 0; v < level.points.size(); ++v)
      shape.mesh.points.push_back(evolved.point(k, v));
    shapes.push_back(shape);
  }
  return shapes;
}

/// What each part encloses.
inline std::vector<double> part_volumes(const LevelShape& shape) {
  std::vector<double> volumes(shape.parts, 0);
  const auto& p = shape.mesh.points;
  for (const auto& t : shape.mesh.triangles)
    volumes[shape.part_of(t)] += p[t[0]].dot(p[t[1]].cross(p[t[2]])) / 6;
  return volumes;
}

inline double volume(const LevelShape& shape) {
  double sum = 0;
  for (const double part : part_volumes(shape)) sum += part;
  return sum;
}

inline double area(const LevelShape& shape) {
  double twice = 0;
  const auto& p = shape.mesh.points;
  for (const auto& t : shape.mesh.triangles)
    twice += (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm();
  return twice / 2;
}

/// Edges with one face only.
inline std::vector<std::pair<std::int32_t, std::int32_t>> boundary(const LevelShape& shape) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> faces;
  for (const auto& t : shape.mesh.triangles)
    for (int i = 0; i < 3; ++i) ++faces[std::minmax(t[i], t[(i + 1) % 3])];
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (const auto& [edge, count] : faces)
    if (count == 1) edges.push_back(edge);
  return edges;
}

}  // namespace semigeo::jobs
