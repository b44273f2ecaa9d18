#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/repair/remeshing.hpp"

namespace semigeo::jobs {

/// Integrals over (some of) the faces of a part.
struct PartMeasure {
  double edge_length = 0;  ///< sum over all edges, each counted once
  double edges = 0;
  double twice_area = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();   ///< of 6 times the area
  Eigen::Vector3d corners = Eigen::Vector3d::Zero();  ///< sum over the corners of all faces
  double squared_corners = 0;                         ///< sum of their squares
  double six_volumes = 0;
  std::int64_t boundary_edges = 0;
  std::int64_t faces = 0;

  PartMeasure& operator+=(const PartMeasure& other);
  /// Of the part enlarged about its centroid.
  PartMeasure scaled(double factor) const;
  double mean_edge_length() const { return edges > 0 ? edge_length / edges : 0; }
  /// Of the area; zero without any.
  Eigen::Vector3d centroid() const;
  /// Root mean square distance of the corners from their mean. Corners, not area: noise adds area.
  double radius_of_gyration() const;
  /// What a closed part encloses; 0 of an open part, and of one that encloses next to nothing.
  double volume() const;
};

/// One measure per part, in double precision. The result does not depend on the number of threads.
std::vector<PartMeasure> measure_parts(const kernels::LevelMesh& mesh,
                                       const engine::RunContext& context);

/// Of all parts together.
double mean_edge_length(const std::vector<PartMeasure>& parts);

}  // namespace semigeo::jobs
