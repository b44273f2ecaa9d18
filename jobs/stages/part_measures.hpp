#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/remeshing.hpp"

namespace semigeo::jobs {

/// Integrals over (some of) the faces of a part.
struct PartMeasure {
  double edge_length = 0;  ///< sum over all edges, each counted once
  double edges = 0;
  double twice_area = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< of 6 times the area
  double second_moment = 0;                          ///< of 24 times the area
  std::int64_t faces = 0;

  PartMeasure& operator+=(const PartMeasure& other);
  double mean_edge_length() const { return edges > 0 ? edge_length / edges : 0; }
  /// Of the area; zero without any.
  Eigen::Vector3d centroid() const;
  /// Root mean square distance of the area from its centroid.
  double radius_of_gyration() const;
};

/// One measure per part, in double precision. The result does not depend on the number of threads.
std::vector<PartMeasure> measure_parts(const kernels::LevelMesh& mesh,
                                       const engine::RunContext& context);

/// Of all parts together.
double mean_edge_length(const std::vector<PartMeasure>& parts);

}  // namespace semigeo::jobs
