#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::kernels {

/// Describes poses that agree; without poses it has no members.
struct GrownCluster {
  Similarity pose;  ///< Mean of its members.
  std::int64_t members = 0;
};

/// Returns the largest cluster of poses, grown as the thesis says. The first pose in no cluster yet
/// is the centre of a new one. Poses closer to the centre than the tolerances join, and the centre
/// becomes their mean each time, until none joins. Where two clusters are equally large, the
/// earlier one is returned. `centre` and `diagonal` are those of the model's bounding box. The cost
/// is clusters times poses. Source: thesis 4.6, steps 1 - 4.
///
/// Differs: the translation of the seven parameters is that of the model's centre instead of d, h,
/// q, which depend on where in the model the triplet lies; the three angles are compared as one
/// rotation, since they jump at their poles.
GrownCluster largest_grown_cluster(std::span<const Similarity> poses, const Eigen::Vector3d& centre,
                                   double diagonal, const PoseTolerance& options);

}  // namespace semigeo::kernels
