#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::kernels {

/// Tells what a scanner saw along the ray through a point.
enum class Sight {
  kThere,     ///< A surface at the point's distance.
  kBehind,    ///< Only surfaces behind the point: no opaque surface can be there.
  kNothing,   ///< No surface at all.
  kInFront,   ///< A surface before the point, which hides it.
  kUnmapped,  ///< The ray leads out of the map.
};

/// Maps how far the surfaces of a scene are from the place that they were scanned from. Queries may
/// run at the same time.
class DepthMap {
 public:
  /// Maps samples that were seen from `eye`. Rays that lead more than about 60 degrees away from
  /// the middle of the samples are not in the map. The cost is linear in the number of samples.
  DepthMap(const SurfaceSamples& scene, const Eigen::Vector3d& eye);

  const Eigen::Vector3f& eye() const { return eye_; }

  /// Tells what was seen along the ray through a point. Distances that differ by no more than
  /// `tolerance` are one. Samples stand for the surface around them: those within one cell of the
  /// map, 1.2 spacings at the median distance, tell what the ray met.
  Sight look(const Eigen::Vector3f& p, float tolerance) const;

 private:
  /// A ray from the eye, and a distance along it.
  struct Ray {
    float u, v;      ///< Where it meets the plane at distance 1 from the eye.
    float distance;  ///< Negative if the ray is not in the map.
  };
  Ray ray_to(const Eigen::Vector3f& p) const;
  std::int64_t column_of(const Ray& ray) const;
  std::int64_t row_of(const Ray& ray) const;
  void place(const std::vector<Ray>& rays);

  Eigen::Vector3f eye_;
  Eigen::Matrix3f frame_ = Eigen::Matrix3f::Identity();  ///< Turns the middle ray to z.
  float usual_ = 0;                                      ///< Median distance of the samples.
  float cells_ = 0;              ///< Number of cells for each unit of the plane at distance 1.
  float left_ = 0, bottom_ = 0;  ///< Where the map begins in that plane.
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> first_;  ///< (cells + 1) First distance of each cell.
  std::vector<float> distances_;     ///< Distances of the samples, cell by cell.
};

}  // namespace semigeo::kernels
