#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "kernels/patch/gaussian.hpp"

namespace semigeo::kernels {

/// One sample of a patch: parameters in steps, the area of parameters that it stands for in
/// steps^2, position relative to the patch's vertex as (x, y, z, 0).
struct PatchSample {
  float u;
  float v;
  float area;
  Eigen::Vector4f position;
};

/// The existing samples of a patch of either kind, in no particular order; no allocation.
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
