#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/hdf5.hpp"

namespace semigeo::io {

// What the writer and the reader of a dataset agree on; io/DATASET.md is its description.

inline constexpr const char* kDatasetFormat = "semigeo-dataset";
inline constexpr std::int64_t kDatasetFormatVersion = 2;
inline constexpr int kMostLevels = 1000;  // three digits

/// Where a dataset comes from; attributes of the root.
struct DatasetHeader {
  std::string parameters_json = "{}";
  std::string input_name;  ///< path of the scan below the folder that was searched, as UTF-8
  std::string input_xxh3;  ///< XXH3_128 of the scan's bytes, 32 hexadecimal digits
  std::string job_key;     ///< hash of everything the content depends on
  std::string length_unit = "unknown";
  std::string repairs_json = "{}";           ///< what was dropped or welded, with counts
  std::string preparation_json = "{}";       ///< what was filled or decimated on request
  std::array<double, 3> origin = {0, 0, 0};  ///< add to the points for the scan's coordinates
};

/// Attributes of one level; lengths in length_unit.
struct LevelAttributes {
  std::int64_t iteration = 0;  ///< smoothings since level 0
  double step = 0;             ///< sampling step of the patches
  double scale = 0;            ///< true sigma; strictly increasing from level to level
  double mean_edge_length = 0;
  std::int64_t parts = 0;    ///< connected parts
  double shortest_side = 0;  ///< no side and no height is shorter; 0: not seen to
  // What remeshing did between the level before and this one.
  std::int64_t flipped = 0;        ///< edges turned to the other diagonal of their two triangles
  std::int64_t split = 0;          ///< edges halved
  std::int64_t collapsed = 0;      ///< edges whose ends became one vertex
  std::int64_t torn = 0;           ///< necks, handles and strips cut
  std::int64_t inserted = 0;       ///< vertices made, in halved edges and along cuts
  std::int64_t removed = 0;        ///< vertices of the level before that are gone
  std::int64_t dropped_parts = 0;  ///< parts removed, too small to carry a patch
};

/// The counts among them, by their names as attributes.
struct LevelCount {
  const char* name;
  std::int64_t LevelAttributes::*count;
};
inline constexpr std::array<LevelCount, 7> kLevelCounts = {{
    {"flipped", &LevelAttributes::flipped},
    {"split", &LevelAttributes::split},
    {"collapsed", &LevelAttributes::collapsed},
    {"torn", &LevelAttributes::torn},
    {"inserted", &LevelAttributes::inserted},
    {"removed", &LevelAttributes::removed},
    {"dropped_parts", &LevelAttributes::dropped_parts},
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
