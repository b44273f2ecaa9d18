#include "kernels/recognition/pose_clusters.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

namespace semigeo::kernels {

using Eigen::Quaternionf;
using Eigen::Vector3d;

namespace {

/// Moves `count` elements that are spread evenly to the front. Both groups keep their order.
void spread_first(std::span<std::int32_t> places, std::ptrdiff_t count) {
  if (count <= 0 || count >= std::ssize(places)) return;
  const double step = static_cast<double>(places.size()) / static_cast<double>(count);
  std::vector<std::int32_t> chosen;
  std::vector<std::int32_t> rest;
  for (std::ptrdiff_t i = 0, next = 0; i < std::ssize(places); ++i) {
    const bool take = i == static_cast<std::ptrdiff_t>((static_cast<double>(next) + 0.5) * step);
    if (take) ++next;
    (take ? chosen : rest).push_back(places[i]);
  }
  std::ranges::copy(rest, std::ranges::copy(chosen, places.begin()).out);
}

}  // namespace

PoseVotes::PoseVotes(std::span<const PoseVote> votes, const Vector3d& centre, double diagonal)
    : centre_(centre), diagonal_(static_cast<float>(diagonal)) {
  placements_.reserve(votes.size());
  for (const PoseVote& vote : votes) placements_.push_back(placement(vote.pose, vote.weight));
  std::ranges::stable_sort(placements_, {}, &Placement::log_scale);
  columns_.resize(std::ssize(placements_), Eigen::NoChange);
  for (std::ptrdiff_t i = 0; i < std::ssize(placements_); ++i)
    columns_.row(i) << placements_[i].centre.transpose().array(),
        placements_[i].rotation.transpose().array();
}

std::vector<PoseCluster> PoseVotes::clusters(const ClusterOptions& options) const {
  std::vector<std::pair<double, std::int32_t>> heavy;
  for (const std::int32_t seed : seeds(options.seeds)) {
    double weight = 0;
    for_agreeing(placements_[seed], options.tolerance,
                 [&](const Placement& p) { weight += p.weight; });
    heavy.emplace_back(-weight, seed);
  }
  std::ranges::sort(heavy);
  std::vector<PoseCluster> result;
  std::vector<Placement> taken;
  for (const auto& [weight, seed] : heavy) {
    if (static_cast<int>(result.size()) >= options.most) break;
    const Placement& p = placements_[seed];
    if (std::ranges::any_of(taken,
                            [&](const Placement& t) { return agree(t, p, options.tolerance); }))
      continue;
    taken.push_back(p);
    result.push_back(cluster_about(p, options.tolerance));
  }
  return result;
}

double PoseVotes::support(const Similarity& pose, const PoseTolerance& tolerance) const {
  double weight = 0;
  for_agreeing(placement(pose, 0), tolerance, [&](const Placement& p) { weight += p.weight; });
  return weight;
}

PoseVotes::Placement PoseVotes::placement(const Similarity& pose, double weight) const {
  const Quaternionf rotation(Eigen::Matrix3f(pose.rotation.cast<float>()));
  return {static_cast<float>(std::log(pose.scale)), pose.apply(centre_).cast<float>(),
          rotation.coeffs(), static_cast<float>(weight)};
}

bool PoseVotes::agree(const Placement& a, const Placement& b,
                      const PoseTolerance& tolerance) const {
  if (std::abs(a.log_scale - b.log_scale) > tolerance.log_scale) return false;
  const float reach = static_cast<float>(tolerance.distance) * diagonal_ * std::exp(a.log_scale);
  if ((a.centre - b.centre).squaredNorm() > reach * reach) return false;
  return std::abs(a.rotation.dot(b.rotation)) >= std::cos(tolerance.angle / 2);
}

template <typename Take>
void PoseVotes::for_agreeing(const Placement& seed, const PoseTolerance& tolerance,
                             const Take& take) const {
  const auto width = static_cast<float>(tolerance.log_scale);
  const float reach = static_cast<float>(tolerance.distance) * diagonal_ * std::exp(seed.log_scale);
  const auto cosine = static_cast<float>(std::cos(tolerance.angle / 2));
  const auto first =
      std::ranges::lower_bound(placements_, seed.log_scale - width, {}, &Placement::log_scale);
  const auto last = std::ranges::upper_bound(first, placements_.end(), seed.log_scale + width, {},
                                             &Placement::log_scale);
  constexpr std::ptrdiff_t kBlock = 256;
  Eigen::Array<float, kBlock, 1> margin;  // by which the limit that is nearer is kept
  const std::ptrdiff_t end = last - placements_.begin();
  for (std::ptrdiff_t i = first - placements_.begin(); i < end; i += kBlock) {
    const std::ptrdiff_t n = std::min(kBlock, end - i);
    const auto p = columns_.middleRows(i, n);
    margin.head(n) = (reach * reach - (p.col(0) - seed.centre[0]).square() -
                      (p.col(1) - seed.centre[1]).square() - (p.col(2) - seed.centre[2]).square())
                         .min((p.col(3) * seed.rotation[0] + p.col(4) * seed.rotation[1] +
                               p.col(5) * seed.rotation[2] + p.col(6) * seed.rotation[3])
                                  .abs() -
                              cosine);
    for (std::ptrdiff_t k = 0; k < n; ++k)
      if (margin[k] >= 0) take(placements_[i + k]);
  }
}

/// Returns seeds: half of them are the heaviest votes, half are spread evenly over the rest. Of
/// votes of one weight that cannot all be among the heaviest, those are taken that are spread
/// evenly over all scales.
std::vector<std::int32_t> PoseVotes::seeds(int most) const {
  std::vector<std::int32_t> order(placements_.size());
  std::iota(order.begin(), order.end(), 0);
  if (order.size() <= static_cast<std::size_t>(most)) return order;
  const std::ptrdiff_t half = most / 2;
  const auto weight = [&](std::int32_t i) { return placements_[i].weight; };
  std::ranges::stable_sort(order, std::ranges::greater(), weight);
  if (half > 0) {
    const float least = weight(order[half - 1]);
    const auto first = std::ranges::lower_bound(order, least, std::ranges::greater(), weight);
    const auto last = std::ranges::upper_bound(order, least, std::ranges::greater(), weight);
    spread_first({first, last}, half - (first - order.begin()));
  }
  std::ranges::sort(order.begin() + half, order.end());
  spread_first({order.begin() + half, order.end()}, most - half);
  order.resize(most);
  return order;
}

PoseCluster PoseVotes::cluster_about(const Placement& seed, const PoseTolerance& tolerance) const {
  PoseCluster cluster;
  double log_scale = 0;
  Vector3d centre = Vector3d::Zero();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  for_agreeing(seed, tolerance, [&](const Placement& p) {
    cluster.weight += p.weight;
    ++cluster.members;
    log_scale += p.weight * p.log_scale;
    centre += p.weight * p.centre.cast<double>();
    rotation += std::copysign(p.weight, p.rotation.dot(seed.rotation)) * p.rotation.cast<double>();
  });
  Similarity& pose = cluster.pose;
  pose.scale = std::exp(log_scale / cluster.weight);
  pose.rotation = Eigen::Quaterniond(rotation.normalized()).toRotationMatrix();
  pose.translation = centre / cluster.weight - pose.scale * (pose.rotation * centre_);
  return cluster;
}

}  // namespace semigeo::kernels
