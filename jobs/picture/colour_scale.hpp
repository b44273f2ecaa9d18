#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

namespace semigeo::jobs {

/// A colour in sRGB: red, green and blue between 0 and 1.
using Colour = std::array<float, 3>;

/// The scales of colours for a field that is symmetric about zero.
enum class ColourScale {
  kSafe,   ///< Blue, white, orange: for all kinds of sight.
  kThesis  ///< Blue, green, red. Source: thesis 6.2.
};
/// The names of the scales, by ColourScale.
inline constexpr std::array<std::string_view, 2> kColourScaleNames = {"safe", "thesis"};

/// The colour of vertices without a valid patch.
inline constexpr Colour kInvalidColour = {0.45f, 0.45f, 0.47f};
/// The colour of a surface without a field.
inline constexpr Colour kPlainColour = {0.72f, 0.74f, 0.78f};

/// Returns a channel of a colour, between 0 and 1, as a byte of an image.
inline std::uint8_t channel_byte(float channel) {
  return static_cast<std::uint8_t>(channel > 0 ? std::lround(255 * std::min(channel, 1.0f)) : 0);
}

/// Returns the colour of a value between -1 and 1. What lies outside has the colour of the end, and
/// NaN has kInvalidColour. The pages of the report have the same scales (report/src/colours.ts).
Colour colour_of(ColourScale scale, float value);

}  // namespace semigeo::jobs
