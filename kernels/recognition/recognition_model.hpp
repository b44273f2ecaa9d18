#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/recognition/triplet.hpp"

namespace semigeo::kernels {

/// Points spread evenly over a surface, with its unit normals there.
struct SurfaceSamples {
  std::vector<Eigen::Vector3f> points;   ///< (M) length units
  std::vector<Eigen::Vector3f> normals;  ///< (M)
  float spacing = 0;                     ///< square root of the area that each stands for
  std::vector<std::uint8_t> rim = {};    ///< (M) 1: near the boundary; empty: there is none
};

/// What a library knows of an object.
struct RecognitionModel {
  std::string name;    ///< of its dataset
  std::string digest;  ///< content digest of its dataset
  std::string length_unit = "unknown";
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< add it for the scan's coordinates
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();  ///< of the bounding box
  float diagonal = 0;                                ///< of the bounding box
  OrientedFeatures features;
  SurfaceSamples samples;
};

}  // namespace semigeo::kernels
