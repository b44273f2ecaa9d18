#include "kernels/recognition/thesis/grown_clusters.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <vector>

namespace semigeo::kernels {
namespace {

/// Holds the seven parameters of a pose.
struct Parameters {
  double log_scale;
  Eigen::Vector3d place;  ///< Place of the model's centre in the scene.
  Eigen::Quaterniond rotation;
};

/// Holds a growing cluster, as sums of the parameters of its members.
class Cluster {
 public:
  Cluster(const Parameters& first, double diagonal, const PoseTolerance& options)
      : centre_(first),
        log_scale_reach_(options.log_scale),
        reach_(options.distance * diagonal),
        least_cosine_(std::cos(options.angle / 2)) {
    add(first);
  }

  bool near(const Parameters& p) const {
    return std::abs(p.log_scale - centre_.log_scale) <= log_scale_reach_ &&
           (p.place - centre_.place).squaredNorm() <= squared_reach_ &&
           // The product of two unit quaternions is the cosine of half the angle between them.
           std::abs(p.rotation.dot(centre_.rotation)) >= least_cosine_;
  }

  void add(const Parameters& p) {
    ++members_;
    log_scale_ += p.log_scale;
    place_ += p.place;
    // The quaternions q and -q are the same rotation.
    rotation_ += (p.rotation.dot(centre_.rotation) < 0 ? -1 : 1) * p.rotation.coeffs();
    const double count = static_cast<double>(members_);
    centre_.log_scale = log_scale_ / count;
    centre_.place = place_ / count;
    centre_.rotation.coeffs() = rotation_.normalized();
    const double reach = reach_ * std::exp(centre_.log_scale);
    squared_reach_ = reach * reach;
  }

  std::int64_t members() const { return members_; }
  Similarity pose(const Eigen::Vector3d& model_centre) const {
    Similarity pose;
    pose.scale = std::exp(centre_.log_scale);
    pose.rotation = centre_.rotation.toRotationMatrix();
    pose.translation = centre_.place - pose.scale * (pose.rotation * model_centre);
    return pose;
  }

 private:
  Parameters centre_;
  double log_scale_reach_;
  double reach_;  ///< Tolerance of the place at scale 1.
  double squared_reach_ = 0;
  double least_cosine_;
  std::int64_t members_ = 0;
  double log_scale_ = 0;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Vector4d rotation_ = Eigen::Vector4d::Zero();
};

}  // namespace

GrownCluster largest_grown_cluster(std::span<const Similarity> poses, const Eigen::Vector3d& centre,
                                   double diagonal, const PoseTolerance& options) {
  std::vector<Parameters> free;  // poses that are in no cluster yet
  free.reserve(poses.size());
  for (const Similarity& pose : poses)
    free.push_back({std::log(pose.scale), pose.apply(centre), Eigen::Quaterniond(pose.rotation)});
  GrownCluster largest;
  // A cluster cannot have more members than there are free poses.
  while (static_cast<std::int64_t>(free.size()) > largest.members) {
    Cluster cluster(free.front(), diagonal, options);
    free.erase(free.begin());
    for (std::size_t before = free.size() + 1; free.size() < before;) {
      before = free.size();
      std::size_t kept = 0;
      for (const Parameters& p : free)
        if (cluster.near(p))
          cluster.add(p);
        else
          free[kept++] = p;
      free.erase(free.begin() + static_cast<std::ptrdiff_t>(kept), free.end());
    }
    if (cluster.members() > largest.members) largest = {cluster.pose(centre), cluster.members()};
  }
  return largest;
}

}  // namespace semigeo::kernels
