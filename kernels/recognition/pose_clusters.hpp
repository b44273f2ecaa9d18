#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/recognition/similarity.hpp"

namespace semigeo::kernels {

/// Holds the pose of a model that one match suggests.
struct PoseVote {
  Similarity pose;  ///< From the model to the scene.
  double weight = 0;
};

/// Describes poses that agree.
struct PoseCluster {
  Similarity pose;    ///< Mean of its members.
  double weight = 0;  ///< Weight of its members together.
  std::int64_t members = 0;
};

/// Tells how much poses may differ that agree.
struct PoseTolerance {
  double log_scale = 0.2;  ///< Logarithm of the scale.
  double distance = 0.1;   ///< Place of the model's centre, in diagonals of the posed model.
  double angle = 0.3;      ///< Rotation, in radians.
};

/// Says how clusters are formed.
struct ClusterOptions {
  PoseTolerance tolerance = {};
  int seeds = 1500;  ///< Number of poses tried: half of them by weight, half spread.
  int most = 120;    ///< Greatest number of clusters.
};

/// Holds the votes of one model, 80 bytes each. Source: thesis 4.6. Differs: poses are
/// similarities, and a cluster is made of all poses that agree with a seed, the best seeds first.
/// In the thesis clusters grow from poses in the order in which they come.
class PoseVotes {
 public:
  PoseVotes() = default;
  /// Takes votes. `centre` and `diagonal` are those of the model's bounding box.
  PoseVotes(std::span<const PoseVote> votes, const Eigen::Vector3d& centre, double diagonal);

  /// Returns groups of poses that agree, the heaviest first. Poses that agree with the seed of a
  /// heavier cluster are no seeds. The cost is seeds times votes. The result depends on the order
  /// of the votes, but not on chance.
  std::vector<PoseCluster> clusters(const ClusterOptions& options = {}) const;

  /// Returns the weight of the votes that agree with a pose.
  double support(const Similarity& pose, const PoseTolerance& tolerance) const;

 private:
  /// A pose as three quantities that can be compared.
  struct Placement {
    float log_scale;
    Eigen::Vector3f centre;
    Eigen::Vector4f rotation;  ///< Unit quaternion.
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
  std::vector<Placement> placements_;  ///< Sorted by scale, so that what may agree is one range.
  /// The centres (3) and rotations (4) of the placements, column by column, for vectors.
  Eigen::Array<float, Eigen::Dynamic, 7> columns_;
};

}  // namespace semigeo::kernels
