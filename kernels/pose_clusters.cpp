#include "kernels/pose_clusters.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace semigeo::kernels {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector4f;

/// A pose as three things that can be compared.
struct Placement {
  float log_scale;
  Vector3f centre;
  Vector4f rotation;  ///< quaternion
  float weight;
};

class Clusterer {
 public:
  Clusterer(std::span<const PoseVote> votes, const Vector3d& centre, double diagonal,
            const ClusterOptions& options)
      : centre_(centre), options_(options), diagonal_(static_cast<float>(diagonal)) {
    std::vector<Placement> placements;
    placements.reserve(votes.size());
    for (const PoseVote& vote : votes) placements.push_back(placement(vote));
    // By scale, so that what may agree is one range.
    std::vector<std::int32_t> order(votes.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](std::int32_t i) { return placements[i].log_scale; });
    for (const std::int32_t i : order) placements_.push_back(placements[i]);
  }

  std::vector<PoseCluster> clusters() const {
    std::vector<std::pair<double, std::int32_t>> heavy;
    for (const std::int32_t seed : seeds()) {
      double weight = 0;
      for_agreeing(placements_[seed], [&](const Placement& p) { weight += p.weight; });
      heavy.emplace_back(-weight, seed);
    }
    std::ranges::sort(heavy);
    std::vector<PoseCluster> result;
    std::vector<Placement> taken;
    for (const auto& [weight, seed] : heavy) {
      if (static_cast<int>(result.size()) >= options_.most) break;
      const Placement& p = placements_[seed];
      if (std::ranges::any_of(taken, [&](const Placement& t) { return agree(t, p); })) continue;
      taken.push_back(p);
      result.push_back(cluster_about(p));
    }
    return result;
  }

 private:
  Placement placement(const PoseVote& vote) const {
    const Quaternionf rotation(Eigen::Matrix3f(vote.pose.rotation.cast<float>()));
    return {static_cast<float>(std::log(vote.pose.scale)), vote.pose.apply(centre_).cast<float>(),
            rotation.coeffs(), static_cast<float>(vote.weight)};
  }

  bool agree(const Placement& a, const Placement& b) const {
    if (std::abs(a.log_scale - b.log_scale) > options_.log_scale) return false;
    const float reach = static_cast<float>(options_.distance) * diagonal_ * std::exp(a.log_scale);
    if ((a.centre - b.centre).squaredNorm() > reach * reach) return false;
    return std::abs(a.rotation.dot(b.rotation)) >= std::cos(options_.angle / 2);
  }

  template <typename Take>
  void for_agreeing(const Placement& seed, const Take& take) const {
    const auto width = static_cast<float>(options_.log_scale);
    const auto reach = static_cast<float>(options_.distance) * diagonal_ * std::exp(seed.log_scale);
    const auto cosine = static_cast<float>(std::cos(options_.angle / 2));
    auto p =
        std::ranges::lower_bound(placements_, seed.log_scale - width, {}, &Placement::log_scale);
    for (; p != placements_.end() && p->log_scale <= seed.log_scale + width; ++p)
      if ((p->centre - seed.centre).squaredNorm() <= reach * reach &&
          std::abs(p->rotation.dot(seed.rotation)) >= cosine)
        take(*p);
  }

  /// Half of them the heaviest votes, half evenly spread over the rest.
  std::vector<std::int32_t> seeds() const {
    std::vector<std::int32_t> order(placements_.size());
    std::iota(order.begin(), order.end(), 0);
    if (order.size() <= static_cast<std::size_t>(options_.seeds)) return order;
    const std::ptrdiff_t half = options_.seeds / 2;
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::int32_t i) { return placements_[i].weight; });
    std::vector<std::int32_t> chosen(order.begin(), order.begin() + half);
    std::vector<std::int32_t> rest(order.begin() + half, order.end());
    std::ranges::sort(rest);
    const double step = static_cast<double>(rest.size()) / static_cast<double>(half);
    for (std::ptrdiff_t i = 0; i < half; ++i)
      chosen.push_back(rest[static_cast<std::size_t>((static_cast<double>(i) + 0.5) * step)]);
    return chosen;
  }

  PoseCluster cluster_about(const Placement& seed) const {
    PoseCluster cluster;
    double log_scale = 0;
    Vector3d centre = Vector3d::Zero();
    Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
    for_agreeing(seed, [&](const Placement& p) {
      cluster.weight += p.weight;
      ++cluster.members;
      log_scale += p.weight * p.log_scale;
      centre += p.weight * p.centre.cast<double>();
      rotation +=
          std::copysign(p.weight, p.rotation.dot(seed.rotation)) * p.rotation.cast<double>();
    });
    Similarity& pose = cluster.pose;
    pose.scale = std::exp(log_scale / cluster.weight);
    pose.rotation = Eigen::Quaterniond(rotation.normalized()).toRotationMatrix();
    pose.translation = centre / cluster.weight - pose.scale * (pose.rotation * centre_);
    return cluster;
  }

  Vector3d centre_;
  ClusterOptions options_;
  float diagonal_;
  std::vector<Placement> placements_;
};

}  // namespace

std::vector<PoseCluster> pose_clusters(std::span<const PoseVote> votes, const Vector3d& centre,
                                       double diagonal, const ClusterOptions& options) {
  return Clusterer(votes, centre, diagonal, options).clusters();
}

}  // namespace semigeo::kernels
