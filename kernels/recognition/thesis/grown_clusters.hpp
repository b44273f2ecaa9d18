#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::kernels {

/// Poses that agree, and how many they are; none of none.
struct GrownCluster {
  Similarity pose;  ///< their mean
  std::int64_t members = 0;
};

/// The largest cluster of poses, grown as the thesis says: the first pose in no cluster yet is the
/// centre of a new one; poses closer to the centre than the tolerances join, and the centre becomes
/// their mean each time, until none joins; of equal ones the earlier. `centre` and `diagonal` are
/// the model's; seeds and most of the options do not count. Cost: clusters times poses.
/// Source: thesis 4.6, steps 1 - 4. Differs: of the seven parameters the translation is that of the
/// model's centre instead of d, h, q, which depend on where in the model the triplet lies; the
/// three angles are compared as one rotation, since they jump at their poles.
GrownCluster largest_grown_cluster(std::span<const Similarity> poses, const Eigen::Vector3d& centre,
                                   double diagonal, const PoseTolerance& options);

}  // namespace semigeo::kernels
