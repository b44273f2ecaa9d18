#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/similarity.hpp"

namespace semigeo::kernels {

/// One match's opinion on where a model is.
struct PoseVote {
  Similarity pose;  ///< model to scene
  double weight = 0;
};

struct PoseCluster {
  Similarity pose;    ///< mean of its members
  double weight = 0;  ///< of its members together
  std::int64_t members = 0;
};

struct ClusterOptions {
  double log_scale = 0.2;  ///< poses agree within: logarithm of the scale,
  double distance = 0.1;   ///< place of the model's centre, in diagonals of the posed model,
  double angle = 0.3;      ///< rotation, in radians
  int seeds = 400;  ///< at most so many poses are tried as centres: half by weight, half spread
  int most = 80;    ///< clusters wanted
};

/// Groups of poses that agree, the heaviest first; clusters that agree with a heavier one are left
/// out. `centre` and `diagonal` are the model's. Cost: seeds times votes. The result depends on the
/// order of the votes, but on no chance.
/// Source: thesis 4.6. Differs: a cluster is all that agrees with its seed, taken about the best
/// seeds, instead of growing from the first pose that comes; poses are similarities.
std::vector<PoseCluster> pose_clusters(std::span<const PoseVote> votes,
                                       const Eigen::Vector3d& centre, double diagonal,
                                       const ClusterOptions& options);

}  // namespace semigeo::kernels
