#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/repeatability/repeats.hpp"
#include "kernels/features.hpp"

namespace semigeo::repeatability {

/// One mesh, one change, one kind, level and radius.
struct Row {
  std::string mesh;
  std::string change;  ///< name of the case
  kernels::FeatureKind kind = kernels::FeatureKind::gaussian;
  int level = 0;  ///< of the original
  double radius = 0;
  double mean_edge_length = 0;  ///< of the original
  double scale = 0;             ///< of that level
  int changed_level = 0;
  double changed_scale = 0;  ///< of the level compared, in the original's units
  Repeats repeats;
};

/// A row a row.
std::string csv(std::span<const Row> rows);

/// A table a case on stdout, and in the end what comes back best: median over the meshes.
void print(std::span<const Row> rows);

}  // namespace semigeo::repeatability
