#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Holds points spread evenly over a surface, with its unit normals there.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;   ///< (M) In length units.
  std::vector<Eigen::Vector3f> normals;  ///< (M) Of unit length.
  float spacing = 0;                     ///< Square root of the area that each stands for.
  std::vector<std::uint8_t> rim = {};    ///< (M) 1 near the boundary; empty without one.
};

/// Holds what a library knows of an object.
struct RecognitionModel {
  std::string name;    ///< Name of its dataset.
  std::string digest;  ///< Content digest of its dataset.
  std::string length_unit = "unknown";
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< Offset of the points in the scan.
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< Centre of the bounding box.
  float diagonal = 0;                                ///< Diagonal of the bounding box.
  OrientedFeatures features;
  SurfaceSamples samples;
  /// The place that the surface was seen from, in the coordinates of the samples, if it was scanned
  /// from one place.
  std::optional<Eigen::Vector3d> eye = {};
};

/// Returns the same object with its triangles facing the other way: normals and mean curvatures
/// change their sign, Gaussian curvature and torsion do not. The object has no eye any more,
/// because a scanner does not see the backs of triangles.
RecognitionModel turned_over(RecognitionModel model);

}  // namespace semigeo::kernels
