#pragma once

#include "kernels/features/features.hpp"

namespace semigeo::kernels {

// Every member, for tests that compare what was written with what comes back.

inline bool operator==(const Feature& a, const Feature& b) {
  return a.vertex == b.vertex && a.value == b.value && a.prominence == b.prominence &&
         a.position == b.position && a.initial_position == b.initial_position &&
         a.normal == b.normal && a.scale_free_gaussian == b.scale_free_gaussian &&
         a.scale_free_mean == b.scale_free_mean;
}

inline bool operator==(const SampledContours& a, const SampledContours& b) {
  return a.points == b.points && a.torsion == b.torsion && a.offsets == b.offsets &&
         a.closed == b.closed && a.maxima == b.maxima && a.length == b.length;
}

}  // namespace semigeo::kernels
