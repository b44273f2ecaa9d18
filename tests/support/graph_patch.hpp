#pragma once

#include "kernels/patch/patch.hpp"

namespace semigeo::kernels {

/// A whole patch that samples the graph z = height(u, v) over a plane.
template <typename Height>
Patch graph_patch(const Height& height, float step) {
  Patch patch;
  patch.reach_up.fill(kReach);
  patch.reach_down.fill(kReach);
  for (int i = 0; i < kTaps; ++i)
    for (int j = 0; j < kTaps; ++j) {
      const float u = step * static_cast<float>(i - kReach);
      const float v = step * static_cast<float>(j - kReach);
      patch.sample[i][j] = {u, v, height(u, v), 0};
    }
  return patch;
}

/// z = a u^2/2 + b u v + c v^2/2.
inline Patch quadratic_patch(float a, float b, float c, float step) {
  return graph_patch([=](float u, float v) { return a * u * u / 2 + b * u * v + c * v * v / 2; },
                     step);
}

}  // namespace semigeo::kernels
