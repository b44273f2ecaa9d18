#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/hdf5/complete_file.hpp"
#include "kernels/repair/remesh_counts.hpp"

namespace semigeo::io {

// What the writer and the reader of a dataset agree on; docs/formats/dataset.md is its description.

inline constexpr std::int64_t kDatasetFormatVersion = 4;
inline constexpr FileFormat kDatasetFormat = {.name = "semigeo-dataset",
                                              .version = kDatasetFormatVersion,
                                              .noun = "dataset",
                                              .remedy = "give a file that `semigeo run` made"};
inline constexpr int kMostLevels = 1000;  // three digits

/// Attributes of one level; lengths in length_unit.
struct LevelAttributes {
  std::int64_t iteration = 0;  ///< smoothings since level 0
  double step = 0;             ///< sampling step of the patches
  double scale = 0;            ///< true sigma; strictly increasing from level to level
  double mean_edge_length = 0;
  std::int64_t parts = 0;               ///< connected parts
  double shortest_side = 0;             ///< no side and no height is shorter; 0: not seen to
  kernels::RemeshCounts remeshed = {};  ///< what was done to the level before
};

/// Those of the counts that are attributes, by their names.
struct LevelCount {
  const char* name;
  std::int64_t kernels::RemeshCounts::*count;
};
inline constexpr std::array<LevelCount, 7> kLevelCounts = {{
    {"flipped", &kernels::RemeshCounts::flipped},
    {"split", &kernels::RemeshCounts::split},
    {"collapsed", &kernels::RemeshCounts::collapsed},
    {"torn", &kernels::RemeshCounts::torn},
    {"inserted", &kernels::RemeshCounts::inserted},
    {"removed", &kernels::RemeshCounts::removed},
    {"dropped_parts", &kernels::RemeshCounts::dropped_parts},
}};

/// Which levels have an array.
enum class Presence {
  always,
  principal,  ///< all, where principal curvatures were asked for
  filled      ///< all, where holes were to be filled
};

/// An array of a level: (N) or (N, columns) over its vertices, or over its triangles.
struct LevelArray {
  const char* name;
  ElementType type;
  int columns;
  bool per_triangle;
  bool connectivity;  ///< shared by the levels until one brings its own
  Presence presence;
};
inline constexpr std::array<LevelArray, 14> kLevelArrays = {{
    {"points", ElementType::float32, 3, false, false, Presence::always},
    {"normals", ElementType::float32, 3, false, false, Presence::always},
    {"gaussian_curvature", ElementType::float32, 1, false, false, Presence::always},
    {"mean_curvature", ElementType::float32, 1, false, false, Presence::always},
    {"patch_completeness", ElementType::float32, 1, false, false, Presence::always},
    {"principal_curvature_1", ElementType::float32, 1, false, false, Presence::principal},
    {"principal_curvature_2", ElementType::float32, 1, false, false, Presence::principal},
    {"principal_direction_1", ElementType::float32, 3, false, false, Presence::principal},
    {"principal_direction_2", ElementType::float32, 3, false, false, Presence::principal},
    {"triangles", ElementType::int64, 3, true, true, Presence::always},
    {"source_vertex", ElementType::int64, 1, false, true, Presence::always},
    {"part", ElementType::int32, 1, false, true, Presence::always},
    {"vertex_filled", ElementType::uint8, 1, false, true, Presence::filled},
    {"face_filled", ElementType::uint8, 1, true, true, Presence::filled},
}};

/// "/levels/007".
std::string level_path(std::int64_t level);

}  // namespace semigeo::io
