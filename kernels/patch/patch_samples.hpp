#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {

/// Describes one sample of a patch.
struct PatchSample {
  float u;                   ///< In steps.
  float v;                   ///< In steps.
  float area;                ///< Area of parameters that the sample stands for, in steps^2.
  Eigen::Vector4f position;  ///< Relative to the vertex of the patch, as (x, y, z, 0).
};

/// Holds the existing samples of a patch of either kind, in no particular order, without
/// allocation.
class PatchSamples {
 public:
  static constexpr std::size_t kCapacity = kTaps * kTaps;

  void push_back(const PatchSample& sample) { samples_[size_++] = sample; }
  std::size_t size() const { return size_; }
  const PatchSample& operator[](std::size_t i) const { return samples_[i]; }

 private:
  std::array<PatchSample, kCapacity> samples_;
  std::size_t size_ = 0;
};

}  // namespace semigeo::kernels
