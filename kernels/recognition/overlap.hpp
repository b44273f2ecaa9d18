#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/recognition/depth_map.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/recognition/slippage.hpp"

namespace semigeo::kernels {

/// Finds the sample nearest to a point. Queries may run at the same time.
class SampleTree {
 public:
  /// Builds the tree. It keeps a reference to the samples, which must neither move nor change.
  explicit SampleTree(const SurfaceSamples& samples);
  ~SampleTree();
  SampleTree(SampleTree&&) noexcept;

  const SurfaceSamples& samples() const { return *samples_; }
  /// Returns the index of the nearest sample, or -1 if none is nearer than `limit`. `guess` is a
  /// sample that may be near, such as the one that was nearest before p moved a little, or -1; it
  /// makes the search shorter.
  std::int64_t nearest(const Eigen::Vector3f& p, float limit, std::int64_t guess = -1) const;

  /// Returns the index of the nearest sample whose normal is less than 90 degrees from this one, or
  /// -1 if none is nearer than `limit`. Thin parts have samples of their other side as near as
  /// their own.
  std::int64_t nearest_facing(const Eigen::Vector3f& p, const Eigen::Vector3f& normal,
                              float limit) const;

  /// Fills `found` with the indices of the samples that are nearer to a point than `limit`,
  /// ascending.
  void within(const Eigen::Vector3f& p, float limit, std::vector<std::uint32_t>& found) const;

 private:
  struct Tree;
  const SurfaceSamples* samples_;
  std::unique_ptr<Tree> tree_;
};

/// Tells when samples match. Distances are in diagonals of the posed model.
struct OverlapOptions {
  double match = 0.01;      ///< Surfaces that are nearer, and face the same way, match.
  double conflict = 0.04;   ///< Surfaces that are nearer, but do not match, contradict each other.
  double min_cosine = 0.8;  ///< Least cosine between normals that face the same way.
  bool stability = false;   ///< Whether `Overlap::stability` is computed.
  /// What a scanner saw of the scene. If it is given, `Overlap::view` is computed.
  const DepthMap* depths = nullptr;
};

/// Tells how a posed model lies in what a scanner saw from one place. Only samples count that face
/// the scanner, by less than 70 degrees. Shares are of all samples.
struct View {
  double there = 0;    ///< Share that lies at the distance that was measured.
  double behind = 0;   ///< Share that would have hidden what was seen behind it.
  double nothing = 0;  ///< Share that lies where nothing was seen.
  /// Share of those `there` near the scene's surface, and not at its rim, that do not match it.
  double opposed = 0;

  /// Returns the share that should have been seen: all but what something hides.
  double visible() const { return there + behind + nothing; }
};

/// Tells how a posed model lies in a scene.
struct Overlap {
  double match = 0;      ///< Share of the model's samples that lie on the scene's surface.
  double conflict = 0;   ///< Share of the model's samples near the surface that contradict it.
  double closeness = 0;  ///< Mean of 1 - (distance / tolerance)^2 over the samples that match.
  double stability = 0;  ///< How firmly the samples that match hold it: Slippage::stability.
  View view = {};        ///< How it lies in what a scanner saw.

  /// Returns the match, reduced by contradiction: match closeness (match / (match + conflict))^2.
  double agreement() const;
};

/// Compares the first `count` samples of a posed model with a scene. `diagonal` is the diagonal of
/// the model before it is posed. A sample near the scene's surface matches or contradicts it; a
/// sample far from it is neutral. A sample is also neutral if it lies nearest to one that `used`
/// marks as part of another object (`used` may be empty). In a scene with a rim, a sample that does
/// not match is neutral if it lies nearest to the rim, or if it lies behind the surface and faces
/// the other way, like the far side of an object that was scanned from one side. Source:
/// thesis 4.6. Differs: surfaces are compared, not triplets.
Overlap overlap(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                const SampleTree& scene, const OverlapOptions& options, std::int64_t count,
                std::span<const std::uint8_t> used = {});

/// Returns other poses in which a nearly symmetric model may fit as well as in this one: the 23
/// turns of a cube that lies along the principal axes of its samples, and, where the surface that
/// matches can turn along itself, a full circle of turns about its axis. `options` tell what
/// matches.
std::vector<Similarity> symmetric_poses(const SurfaceSamples& model, double diagonal,
                                        const Similarity& pose, const SampleTree& scene,
                                        const OverlapOptions& options, std::int64_t count);

/// Returns how a posed model can grow and shrink along the surface that matches it; see
/// `Slippage::free_scaling`. `options` tell what matches.
std::optional<ScalingMotion> free_scaling(const SurfaceSamples& model, double diagonal,
                                          const Similarity& pose, const SampleTree& scene,
                                          const OverlapOptions& options, std::int64_t count,
                                          double most);

/// Marks the scene's samples that lie on the posed model: result[i] = 1. Only the first `count`
/// samples with used[i] = 0 are examined. `model` holds the samples of the model.
std::vector<std::uint8_t> samples_on_model(const SampleTree& model, double diagonal,
                                           const Similarity& pose, const SurfaceSamples& scene,
                                           const OverlapOptions& options, std::int64_t count,
                                           std::span<const std::uint8_t> used = {});

/// Says how a pose is refined.
struct RefineOptions {
  std::vector<double> reach = {0.05, 0.02, 0.01, 0.008};  ///< Limit of each stage, in diagonals.
  int iterations = 4;                                     ///< Number of iterations of each stage.
  std::int64_t count = 500;                               ///< Number of samples of the model.
  double min_cosine = 0.6;                                ///< Least cosine between normals.
};

/// Moves, turns and scales a posed model until it lies on the scene's surface, by least squares of
/// the distances of its samples from the planes of the nearest scene samples (iterative closest
/// points). Motions that the scene does not determine, such as a shift along a plane, are left out.
/// The result depends on the arguments alone.
Similarity refine_pose(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                       const SampleTree& scene, const RefineOptions& options);

}  // namespace semigeo::kernels
