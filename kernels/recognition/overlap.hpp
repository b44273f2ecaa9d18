#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"
#include "kernels/recognition/similarity.hpp"

namespace semigeo::kernels {

/// Finds the sample nearest to a point. Queries may run at the same time.
class SampleTree {
 public:
  /// Keeps a reference to the samples, which must neither move nor change.
  explicit SampleTree(const SurfaceSamples& samples);
  ~SampleTree();
  SampleTree(SampleTree&&) noexcept;

  const SurfaceSamples& samples() const { return *samples_; }
  /// Its index, or -1 if none is nearer than `limit`. `guess`: a sample that may be near, such as
  /// what was nearest before p moved a little, or -1; it makes the search shorter.
  std::int64_t nearest(const Eigen::Vector3f& p, float limit, std::int64_t guess = -1) const;

 private:
  struct Tree;
  const SurfaceSamples* samples_;
  std::unique_ptr<Tree> tree_;
};

/// Distances in diagonals of the posed model.
struct OverlapOptions {
  double match = 0.01;      ///< surfaces that are nearer, and face the same way, are one
  double conflict = 0.04;   ///< surfaces that are nearer, but not one, contradict each other
  double min_cosine = 0.8;  ///< between normals that face the same way
  bool stability = false;   ///< find it out, too
};

/// How a posed model lies in a scene.
struct Overlap {
  double match = 0;      ///< share of the model's samples that lie on the scene's surface
  double conflict = 0;   ///< share of those near it that disagree; what is far from it is neutral
  double closeness = 0;  ///< of what matches: mean of 1 - (distance / tolerance)^2
  /// Of what matches: how firmly it holds the model, see Slippage::stability.
  double stability = 0;

  /// What a match is worth that is contradicted: match closeness (match / (match + conflict))^2.
  double agreement() const;
};

/// Of the first `count` samples of the model. `used` marks samples of the scene that belong to
/// something else already: what lies on them is neutral; empty: none. Neutral as well: what is
/// nearest to the scene's rim; and, in a scene with a rim, what faces the other way behind the
/// scene's surface, as the far sides of objects do that were seen from one side.
/// Source: thesis 4.6. Differs: surfaces are compared, not triplets.
Overlap overlap(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                const SampleTree& scene, const OverlapOptions& options, std::int64_t count,
                std::span<const std::uint8_t> used = {});

/// Other poses that nearly symmetric models fit as well as in this one: half turns about the
/// principal axes of their samples, and, where the surface that matches can turn along itself, a
/// full circle of turns about its axis. `options` tell what matches.
std::vector<Similarity> turned(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                               const SampleTree& scene, const OverlapOptions& options,
                               std::int64_t count);

/// Marks the scene's samples that lie on the posed model: result[i] = 1. Looks at the first `count`
/// of them, and at those with used[i] = 0 only. `model` are the samples of the model.
std::vector<std::uint8_t> explained(const SampleTree& model, double diagonal,
                                    const Similarity& pose, const SurfaceSamples& scene,
                                    const OverlapOptions& options, std::int64_t count,
                                    std::span<const std::uint8_t> used = {});

struct RefineOptions {
  std::vector<double> reach = {0.05, 0.02, 0.01, 0.008};  ///< stage by stage, in diagonals
  int iterations = 4;                                     ///< of each stage
  std::int64_t count = 500;                               ///< first samples of the model
  double min_cosine = 0.6;
};

/// Moves, turns and scales a posed model until it lies on the scene's surface: least squares of
/// the distances of its samples from the planes of the nearest scene samples (iterative closest
/// points). What the scene does not fix, such as the place on a plane, stays. Deterministic.
Similarity refined(const SurfaceSamples& model, double diagonal, const Similarity& pose,
                   const SampleTree& scene, const RefineOptions& options);

}  // namespace semigeo::kernels
