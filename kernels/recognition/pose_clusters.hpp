#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/similarity.hpp"

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

/// When two poses agree.
struct PoseTolerance {
  double log_scale = 0.2;  ///< logarithm of the scale
  double distance = 0.1;   ///< place of the model's centre, in diagonals of the posed model
  double angle = 0.3;      ///< rotation, in radians
};

struct ClusterOptions {
  PoseTolerance tolerance = {};
  int seeds = 600;  ///< at most so many poses are tried: half by weight, half spread
  int most = 120;   ///< clusters wanted
};

/// The votes of one model, 40 bytes each.
/// Source: thesis 4.6. Differs: a cluster is all that agrees with its seed, taken about the best
/// seeds, instead of growing from the first pose that comes; poses are similarities.
class PoseVotes {
 public:
  PoseVotes() = default;
  /// `centre` and `diagonal` are the model's.
  PoseVotes(std::span<const PoseVote> votes, const Eigen::Vector3d& centre, double diagonal);

  /// Groups of poses that agree, the heaviest first; what agrees with the seed of a heavier one is
  /// none. Cost: seeds times votes. Depends on the order of the votes, but on no chance.
  std::vector<PoseCluster> clusters(const ClusterOptions& options = {}) const;

  /// Weight of the votes that agree with a pose.
  double support(const Similarity& pose, const PoseTolerance& tolerance) const;

 private:
  /// A pose as three things that can be compared.
  struct Placement {
    float log_scale;
    Eigen::Vector3f centre;
    Eigen::Vector4f rotation;  ///< quaternion
    float weight;
  };
  Placement placement(const Similarity& pose, double weight) const;
  bool agree(const Placement& a, const Placement& b, const PoseTolerance& tolerance) const;
  template <typename Take>
  void for_agreeing(const Placement& seed, const PoseTolerance& tolerance, const Take& take) const;
  std::vector<std::int32_t> seeds(int most) const;
  PoseCluster cluster_about(const Placement& seed, const PoseTolerance& tolerance) const;

  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  float diagonal_ = 0;
  std::vector<Placement> placements_;  ///< by scale, so that what may agree is one range
};

}  // namespace semigeo::kernels
