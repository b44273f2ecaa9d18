#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/hdf5/complete_file.hpp"
#include "kernels/repair/remesh_counts.hpp"

namespace semigeo::io {

// The format of a dataset, for its writer and its reader. docs/formats/dataset.md describes it.

/// The version of the format.
inline constexpr std::int64_t kDatasetFormatVersion = 4;
/// The words by which a dataset is recognised.
inline constexpr FileFormat kDatasetFormat = {.name = "semigeo-dataset",
                                              .version = kDatasetFormatVersion,
                                              .noun = "dataset",
                                              .remedy = "give a file that `semigeo run` made"};
/// The largest number of levels, because the number of a level has three digits.
inline constexpr int kMostLevels = 1000;

/// The attributes of one level. Lengths are in length_unit.
struct LevelAttributes {
  std::int64_t iteration = 0;  ///< Number of smoothings since level 0.
  double step = 0;             ///< Sampling step of the patches.
  double scale = 0;            ///< True sigma. It increases strictly from level to level.
  double mean_edge_length = 0;
  std::int64_t parts = 0;  ///< Number of connected parts.
  /// No side and no height of a triangle is shorter; 0 if the level was not remeshed.
  double shortest_side = 0;
  /// Coordinates of points are multiples of it; 0 if they were not rounded.
  double point_quantum = 0;
  kernels::RemeshCounts remeshed = {};  ///< What remeshing did to the level before.
};

/// A count of remeshing that is an attribute, with its name.
struct LevelCount {
  const char* name;
  std::int64_t kernels::RemeshCounts::*count;
};
/// All counts of remeshing that are attributes.
inline constexpr std::array<LevelCount, 7> kLevelCounts = {{
    {"flipped", &kernels::RemeshCounts::flipped},
    {"split", &kernels::RemeshCounts::split},
    {"collapsed", &kernels::RemeshCounts::collapsed},
    {"torn", &kernels::RemeshCounts::torn},
    {"inserted", &kernels::RemeshCounts::inserted},
    {"removed", &kernels::RemeshCounts::removed},
    {"dropped_parts", &kernels::RemeshCounts::dropped_parts},
}};

/// Says which datasets have an array.
enum class Presence {
  kAlways,     ///< All datasets.
  kPrincipal,  ///< Datasets for which principal curvatures were asked for.
  kFilled      ///< Datasets whose holes were to be filled.
};

/// Describes an array of a level: (N) or (N, columns) over its vertices, or over its triangles.
struct LevelArray {
  const char* name;
  ElementType type;
  int columns;
  bool per_triangle;
  bool connectivity;  ///< Levels share it until one brings its own.
  Presence presence;
};
/// All arrays of a level.
inline constexpr std::array<LevelArray, 14> kLevelArrays = {{
    {"points", ElementType::kFloat32, 3, false, false, Presence::kAlways},
    {"normals", ElementType::kFloat32, 3, false, false, Presence::kAlways},
    {"gaussian_curvature", ElementType::kFloat32, 1, false, false, Presence::kAlways},
    {"mean_curvature", ElementType::kFloat32, 1, false, false, Presence::kAlways},
    {"patch_completeness", ElementType::kFloat32, 1, false, false, Presence::kAlways},
    {"principal_curvature_1", ElementType::kFloat32, 1, false, false, Presence::kPrincipal},
    {"principal_curvature_2", ElementType::kFloat32, 1, false, false, Presence::kPrincipal},
    {"principal_direction_1", ElementType::kFloat32, 3, false, false, Presence::kPrincipal},
    {"principal_direction_2", ElementType::kFloat32, 3, false, false, Presence::kPrincipal},
    {"triangles", ElementType::kInt64, 3, true, true, Presence::kAlways},
    {"source_vertex", ElementType::kInt64, 1, false, true, Presence::kAlways},
    {"part", ElementType::kInt32, 1, false, true, Presence::kAlways},
    {"vertex_filled", ElementType::kUint8, 1, false, true, Presence::kFilled},
    {"face_filled", ElementType::kUint8, 1, true, true, Presence::kFilled},
}};

/// Returns the path of a level: "/levels/007".
std::string level_path(std::int64_t level);

}  // namespace semigeo::io
