#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/repeatability/repeats.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::repeatability {

/// Describes the result for one mesh, change, kind of features, level and radius.
struct Row {
  std::string mesh;    ///< Name of the mesh.
  std::string change;  ///< Name of the case.
  kernels::FeatureKind kind = kernels::FeatureKind::kGaussian;
  int level = 0;                ///< Level of the original.
  double radius = 0;            ///< Radius in scales; 0 for torsion, which has none.
  double mean_edge_length = 0;  ///< Mean edge length of the original.
  double scale = 0;             ///< Scale of the level of the original.
  int changed_level = 0;        ///< Level of the changed mesh that it is compared with.
  double changed_scale = 0;     ///< Scale of that level, in the original's units.
  Repeats repeats;
};

/// Returns whether maxima of this kind are compared within a radius.
constexpr bool has_radius(kernels::FeatureKind kind) {
  return kind == kernels::FeatureKind::kGaussian || kind == kernels::FeatureKind::kMean;
}

/// Returns a CSV file with a line of headings. Columns have the order of the members.
std::string csv(std::span<const Row> rows);

/// Prints a table for each case on stdout, and last the kind, level and radius whose features
/// reappear best, by the median over the meshes.
void print(std::span<const Row> rows);

}  // namespace semigeo::repeatability
