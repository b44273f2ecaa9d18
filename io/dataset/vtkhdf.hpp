#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/dataset/dataset_format.hpp"
#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {

/// One level of a dataset as a time step.
struct VtkhdfStep {
  double value = 0;   ///< the level's scale
  std::string level;  ///< its group: "/levels/000"
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  bool new_connectivity = false;  ///< its triangles are not those of the step before
  bool principal = false;         ///< it has principal curvatures; as all steps or none
  bool filled = false;            ///< it has marks of filled vertices; as all steps or none
};

/// A per-vertex array of a level and its name in /VTKHDF/PointData.
struct VtkhdfPointArray {
  const char* name;
  const char* source;
  ElementType type;
  int columns;
  Presence presence;
};
inline constexpr std::array<VtkhdfPointArray, 11> kVtkhdfPointArrays = {{
    {"Normals", "normals", ElementType::float32, 3, Presence::always},
    {"gaussian_curvature", "gaussian_curvature", ElementType::float32, 1, Presence::always},
    {"mean_curvature", "mean_curvature", ElementType::float32, 1, Presence::always},
    {"patch_completeness", "patch_completeness", ElementType::float32, 1, Presence::always},
    {"part", "part", ElementType::int32, 1, Presence::always},
    {"source_vertex", "source_vertex", ElementType::int64, 1, Presence::always},
    {"principal_curvature_1", "principal_curvature_1", ElementType::float32, 1,
     Presence::principal},
    {"principal_curvature_2", "principal_curvature_2", ElementType::float32, 1,
     Presence::principal},
    {"principal_direction_1", "principal_direction_1", ElementType::float32, 3,
     Presence::principal},
    {"principal_direction_2", "principal_direction_2", ElementType::float32, 3,
     Presence::principal},
    {"vertex_filled", "vertex_filled", ElementType::uint8, 1, Presence::filled},
}};

/// Those of the arrays that a step has.
std::vector<VtkhdfPointArray> point_arrays_of(const VtkhdfStep& step);

/// Everything that /VTKHDF holds, planned before any of it is written.
struct VtkhdfLayout {
  struct Table {
    int columns = 1;
    std::vector<std::int64_t> values;  ///< row after row
  };
  struct View {
    ElementType type = ElementType::float32;
    int columns = 1;
    std::vector<VirtualPiece> pieces;
  };
  std::string type = "PolyData";
  std::vector<std::int64_t> version = {2, 0};
  std::int64_t steps = 0;
  std::vector<double> values;                   ///< one per step
  std::vector<std::int64_t> triangles_of_part;  ///< one part, or one per step
  std::map<std::string, Table> tables;          ///< int64, by path relative to /VTKHDF
  std::map<std::string, View> views;            ///< virtual, by path relative to /VTKHDF
};

/// VTKHDF 2.0 temporal PolyData over the levels: one part that all steps share if the
/// connectivity never changes, else one part per step.
VtkhdfLayout vtkhdf_layout(std::span<const VtkhdfStep> steps);

/// Writes the group /VTKHDF; the arrays that the views show must exist.
void write_vtkhdf(DigestedFile& file, const VtkhdfLayout& layout, Compression compression);

/// Error naming the object that breaks a rule of VTKHDF or of how VTK's reader takes it. Reads
/// the offsets and Polygons/Offsets, none of the big arrays.
void check_vtkhdf(const Hdf5File& file);

}  // namespace semigeo::io
