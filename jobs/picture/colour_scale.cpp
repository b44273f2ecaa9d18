#include "jobs/picture/colour_scale.hpp"

#include <algorithm>
#include <cmath>

namespace semigeo::jobs {
namespace {

constexpr std::size_t kStops = 5;

constexpr std::array<std::array<Colour, kStops>, kColourScaleNames.size()> kStopsOf = {{
    {{{0.02f, 0.19f, 0.45f},
      {0.35f, 0.62f, 0.85f},
      {0.95f, 0.95f, 0.94f},
      {0.93f, 0.6f, 0.27f},
      {0.5f, 0.2f, 0.02f}}},
    {{{0, 0, 1}, {0, 1, 1}, {0, 0.85f, 0}, {1, 1, 0}, {1, 0, 0}}},
}};

}  // namespace

Colour colour_of(ColourScale scale, float value) {
  if (std::isnan(value)) return kInvalidColour;
  const auto& stops = kStopsOf[static_cast<std::size_t>(scale)];
  const float place = std::clamp((value + 1) / 2, 0.0f, 1.0f) * (kStops - 1);
  const std::size_t first = std::min(kStops - 2, static_cast<std::size_t>(place));
  const float share = place - static_cast<float>(first);
  Colour colour = {};
  for (std::size_t i = 0; i < colour.size(); ++i)
    colour[i] = stops[first][i] + share * (stops[first + 1][i] - stops[first][i]);
  return colour;
}

}  // namespace semigeo::jobs
