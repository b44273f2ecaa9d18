#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/repair/remeshing.hpp"

namespace semigeo::jobs {

/// Integrals over faces of one part. Measures of disjoint sets of faces can be added.
struct PartMeasure {
  double edge_length = 0;  ///< Sum of the lengths of all edges but outliers, each counted once.
  double edges = 0;        ///< Number of those edges.
  double twice_area = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< First moment of 6 times the area.
  /// Sum over the corners of all faces without outliers among their edges.
  Eigen::Vector3d corners = Eigen::Vector3d::Zero();
  double squared_corners = 0;  ///< Sum of the squared norms of those corners.
  double corner_count = 0;     ///< Number of those corners.
  double six_volumes = 0;
  std::int64_t boundary_edges = 0;
  std::int64_t faces = 0;

  PartMeasure& operator+=(const PartMeasure& other);
  /// Returns the measure of the part enlarged about its centroid.
  PartMeasure scaled(double factor) const;
  double mean_edge_length() const { return edges > 0 ? edge_length / edges : 0; }
  /// Returns the centroid of the area, or zero if there is no area.
  Eigen::Vector3d centroid() const;
  /// Returns the root mean square distance of the corners from their mean. Corners are used instead
  /// of area because noise adds area. Those at outliers do not count: one alone would decide.
  double radius_of_gyration() const;
  /// Returns the volume that a closed part encloses. The result is 0 if the part is open, has
  /// outliers or encloses almost nothing.
  double volume() const;
};

/// Returns one measure for each part, in double precision. Edges longer than `edge_limit` are
/// outliers; see `kernels::edge_lengths`. The result does not depend on the number of threads.
std::vector<PartMeasure> measure_parts(const kernels::LevelMesh& mesh, double edge_limit,
                                       const engine::RunContext& context);

/// Returns the mean edge length of all parts together.
double mean_edge_length(const std::vector<PartMeasure>& parts);

}  // namespace semigeo::jobs
