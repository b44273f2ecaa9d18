#include "kernels/recognition/curvature_frame.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace semigeo::kernels {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Fits the shape operator to the normals of the samples about one of them: normals change by it
/// times the way. Returns nothing where the surface is too flat, too round or too uneven.
std::optional<CurvatureFrame> frame_at(const SurfaceSamples& samples, std::size_t at,
                                       std::span<const std::uint32_t> near, double radius,
                                       const FrameOptions& options) {
  constexpr int kFewest = 8;
  constexpr float kMinCosine = 0.3F;
  const Vector3f& normal = samples.normals[at];
  const Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
  Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double turned = 0;
  int count = 0;
  for (const std::uint32_t i : near) {
    if (samples.normals[i].dot(normal) < kMinCosine) continue;
    const Vector3f way = samples.points[i] - samples.points[at];
    const Vector3f turn = samples.normals[i] - normal;
    const double x = way.dot(u), y = way.dot(v), a = turn.dot(u), b = turn.dot(v);
    // a = e x + f y, b = f x + g y
    const Vector3d row_a(x, y, 0), row_b(0, x, y);
    left += row_a * row_a.transpose() + row_b * row_b.transpose();
    right += row_a * a + row_b * b;
    turned += a * a + b * b;
    ++count;
  }
  if (count < kFewest) return {};
  const Vector3d fit = left.ldlt().solve(right);
  if (!fit.allFinite()) return {};
  const double residual = turned - 2 * fit.dot(right) + fit.dot(left * fit);
  if (residual > options.most_residual * turned) return {};
  Eigen::Matrix2d shape;
  shape << fit[0], fit[1], fit[1], fit[2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(shape);
  const Eigen::Vector2d curvatures = principal.eigenvalues();
  const int larger = std::abs(curvatures[0]) > std::abs(curvatures[1]) ? 0 : 1;
  const double ratio = curvatures[1 - larger] / curvatures[larger];
  if (std::abs(curvatures[larger]) * radius < options.least_bend ||
      !(std::abs(ratio) <= options.most_ratio))
    return {};
  const Eigen::Vector2f direction = principal.eigenvectors().col(larger).cast<float>();
  return CurvatureFrame{.point = samples.points[at],
                        .normal = normal,
                        .direction = direction[0] * u + direction[1] * v,
                        .curvature = static_cast<float>(curvatures[larger]),
                        .ratio = static_cast<float>(ratio)};
}

}  // namespace

std::vector<CurvatureFrame> curvature_frames(const SampleTree& tree, const FrameOptions& options,
                                             std::span<const std::uint8_t> used) {
  const SurfaceSamples& samples = tree.samples();
  const double radius = options.radius * samples.spacing;
  std::vector<CurvatureFrame> frames;
  std::vector<std::uint32_t> near;
  // The first n samples are spread evenly, for any n.
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    if (std::ssize(frames) >= options.most) break;
    if ((!used.empty() && used[i] != 0) || (!samples.rim.empty() && samples.rim[i] != 0)) continue;
    tree.within(samples.points[i], static_cast<float>(radius), near);
    if (const auto frame = frame_at(samples, i, near, radius, options)) frames.push_back(*frame);
  }
  return frames;
}

std::array<Similarity, 2> similarities_between(const CurvatureFrame& from,
                                               const CurvatureFrame& to) {
  const auto axes = [](const CurvatureFrame& frame) {
    Eigen::Matrix3d columns;
    columns << frame.direction.cast<double>(), frame.normal.cast<double>(),
        frame.direction.cross(frame.normal).cast<double>();
    return columns;
  };
  std::array<Similarity, 2> result;
  for (int turned = 0; turned < 2; ++turned) {
    Similarity& pose = result[turned];
    Eigen::Matrix3d target = axes(to);
    if (turned == 1) {
      target.col(0) *= -1;
      target.col(2) *= -1;
    }
    pose.scale = static_cast<double>(from.curvature) / to.curvature;
    pose.rotation = target * axes(from).transpose();
    pose.translation =
        to.point.cast<double>() - pose.scale * (pose.rotation * from.point.cast<double>());
  }
  return result;
}

std::vector<PoseVote> votes_of_frames(std::span<const CurvatureFrame> scene,
                                      std::span<const CurvatureFrame> model, double tolerance) {
  std::vector<PoseVote> votes;
  std::vector<std::size_t> alike;
  for (const CurvatureFrame& s : scene) {
    alike.clear();
    for (std::size_t i = 0; i < model.size(); ++i)
      if ((model[i].curvature > 0) == (s.curvature > 0) &&
          std::abs(model[i].ratio - s.ratio) <= tolerance)
        alike.push_back(i);
    for (const std::size_t i : alike)
      for (const Similarity& pose : similarities_between(model[i], s))
        votes.push_back({pose, 0.5 / static_cast<double>(alike.size())});
  }
  return votes;
}

}  // namespace semigeo::kernels
