#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "kernels/recognition/overlap.hpp"
#include "kernels/recognition/pose_clusters.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::kernels {

/// Describes a point of a curved surface. Its normal and the direction of its larger curvature are
/// a frame, and the larger curvature is a length: one such point of a model and one of a scene fix
/// a similarity, up to a half turn about the normal.
struct CurvatureFrame {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;
  Eigen::Vector3f direction;  ///< Unit tangent of the larger curvature, with either sign.
  float curvature = 0;        ///< The principal curvature of the larger size; convex is positive.
  float ratio = 0;            ///< The other principal curvature over it, -1 to 1.
};

/// Says which points become frames.
struct FrameOptions {
  double radius = 3;           ///< Radius of the surface that is examined, in sample spacings.
  double least_bend = 0.12;    ///< Least angle by which normals turn within the radius, in radians.
  double most_ratio = 0.8;     ///< Largest size of the ratio: on a sphere no direction is special.
  double most_residual = 0.3;  ///< Largest squared error of the fit, over the squared turns.
  int most = 300;              ///< Largest number of frames.
};

/// Returns frames of samples that are spread evenly. The curvatures are fitted to the normals of
/// the samples nearby. Samples are left out that `used` marks (it may be empty) or that lie near
/// the rim, and where the surface is too flat, too round or too uneven. The cost is about 2 us for
/// each sample that is examined. The function is thread-safe. Source: Rusinkiewicz, Estimating
/// curvatures and their derivatives on triangle meshes (3DPVT 2004), section 3.1. Differs: samples
/// with normals instead of triangles.
std::vector<CurvatureFrame> curvature_frames(const SampleTree& samples, const FrameOptions& options,
                                             std::span<const std::uint8_t> used = {});

/// Returns the two similarities that take `from` to `to`: point to point, normal to normal, line of
/// the direction to line of the direction, curvature to curvature.
std::array<Similarity, 2> similarities_between(const CurvatureFrame& from,
                                               const CurvatureFrame& to);

/// Returns the poses for which frames of a scene and of a model vote: all those of two frames that
/// bend to the same side with ratios that differ by at most `tolerance`. The votes of one frame of
/// the scene together weigh 1. The cost is the product of the numbers of frames.
std::vector<PoseVote> votes_of_frames(std::span<const CurvatureFrame> scene,
                                      std::span<const CurvatureFrame> model, double tolerance);

}  // namespace semigeo::kernels
