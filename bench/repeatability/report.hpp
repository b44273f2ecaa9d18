#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/repeatability/repeats.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::repeatability {

/// One mesh, one change, one kind, level and radius.
struct Row {
  std::string mesh;
  std::string change;  ///< name of the case
  kernels::FeatureKind kind = kernels::FeatureKind::kGaussian;
  int level = 0;                ///< of the original
  double radius = 0;            ///< in scales; 0 for torsion, which has none
  double mean_edge_length = 0;  ///< of the original
  double scale = 0;             ///< of that level
  int changed_level = 0;
  double changed_scale = 0;  ///< of the level compared, in the original's units
  Repeats repeats;
};

/// Whether maxima of this kind are compared within a radius.
constexpr bool has_radius(kernels::FeatureKind kind) {
  return kind == kernels::FeatureKind::kGaussian || kind == kernels::FeatureKind::kMean;
}

/// With a line of headings; quantities in the order of the members.
std::string csv(std::span<const Row> rows);

/// A table a case on stdout, and in the end what comes back best: median over the meshes.
void print(std::span<const Row> rows);

}  // namespace semigeo::repeatability
