#include "kernels/recognition/near_features.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace semigeo::kernels {
namespace {

/// Returns the interval of the squares of [low, high], as floats.
struct SquaredBand {
  float least;
  float most;
  SquaredBand(double low, double high)
      : least(static_cast<float>(low * low)), most(static_cast<float>(high * high)) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    if (least < low * low) least = std::nextafter(least, kInfinity);
    if (most > high * high) most = std::nextafter(most, -kInfinity);
  }
};

}  // namespace

void NearFeatures::find(std::span<const OrientedFeature> of_level, double nearest, double farthest,
                        int most) {
  const SquaredBand band(nearest, farthest);
  const std::size_t count = of_level.size();
  for (int axis = 0; axis < 3; ++axis) {
    places_[axis].resize(count);
    for (std::size_t i = 0; i < count; ++i) places_[axis][i] = of_level[i].position[axis];
  }
  const float* const x = places_[0].data();
  const float* const y = places_[1].data();
  const float* const z = places_[2].data();
  squared_.resize(count);
  near_.clear();
  first_.assign(1, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const float dx = x[j] - x[i];
      const float dy = y[j] - y[i];
      const float dz = z[j] - z[i];
      squared_[j] = dx * dx + (dy * dy + dz * dz);
    }
    in_band_.clear();
    for (std::size_t j = 0; j < count; ++j)
      if (squared_[j] >= band.least && squared_[j] <= band.most)
        // Positive floats have the same order as their bits.
        in_band_.push_back(std::uint64_t{std::bit_cast<std::uint32_t>(squared_[j])} << 32 | j);
    const auto kept = std::min<std::size_t>(in_band_.size(), most);
    std::ranges::partial_sort(in_band_, in_band_.begin() + static_cast<std::ptrdiff_t>(kept));
    for (std::size_t k = 0; k < kept; ++k)
      near_.push_back(static_cast<std::uint16_t>(in_band_[k] & 0xffff));
    first_.push_back(near_.size());
  }
}

}  // namespace semigeo::kernels
