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
  double value = 0;   ///< Scale of the level.
  std::string level;  ///< Group of the level: "/levels/000".
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  bool new_connectivity = false;  ///< Its triangles are not those of the step before.
  bool principal = false;         ///< It has principal curvatures; so has every step, or none.
  bool filled = false;            ///< It has marks of filled vertices; so has every step, or none.
};

/// A per-vertex array of a level and its name in /VTKHDF/PointData.
struct VtkhdfPointArray {
  const char* name;
  const char* source;
  ElementType type;
  int columns;
  Presence presence;
};
/// All arrays of /VTKHDF/PointData.
inline constexpr std::array<VtkhdfPointArray, 11> kVtkhdfPointArrays = {{
    {"Normals", "normals", ElementType::kFloat32, 3, Presence::kAlways},
    {"gaussian_curvature", "gaussian_curvature", ElementType::kFloat32, 1, Presence::kAlways},
    {"mean_curvature", "mean_curvature", ElementType::kFloat32, 1, Presence::kAlways},
    {"patch_completeness", "patch_completeness", ElementType::kFloat32, 1, Presence::kAlways},
    {"part", "part", ElementType::kInt32, 1, Presence::kAlways},
    {"source_vertex", "source_vertex", ElementType::kInt64, 1, Presence::kAlways},
    {"principal_curvature_1", "principal_curvature_1", ElementType::kFloat32, 1,
     Presence::kPrincipal},
    {"principal_curvature_2", "principal_curvature_2", ElementType::kFloat32, 1,
     Presence::kPrincipal},
    {"principal_direction_1", "principal_direction_1", ElementType::kFloat32, 3,
     Presence::kPrincipal},
    {"principal_direction_2", "principal_direction_2", ElementType::kFloat32, 3,
     Presence::kPrincipal},
    {"vertex_filled", "vertex_filled", ElementType::kUint8, 1, Presence::kFilled},
}};

/// Returns the arrays that a step has.
std::vector<VtkhdfPointArray> point_arrays_of(const VtkhdfStep& step);

/// Holds all that is going to be written to /VTKHDF.
struct VtkhdfLayout {
  /// Describes a table that is written with its values.
  struct Table {
    int columns = 1;
    std::vector<std::int64_t> values;  ///< Row after row.
  };
  /// Describes a virtual dataset: a view of arrays of the levels.
  struct View {
    ElementType type = ElementType::kFloat32;
    int columns = 1;
    std::vector<VirtualPiece> pieces;
  };
  std::string type = "PolyData";
  std::vector<std::int64_t> version = {2, 0};
  std::int64_t steps = 0;
  std::vector<double> values;                   ///< One value for each step.
  std::vector<std::int64_t> triangles_of_part;  ///< One part, or one for each step.
  std::map<std::string, Table> tables;  ///< Tables of int64 by their paths relative to /VTKHDF.
  std::map<std::string, View> views;    ///< Virtual datasets by their paths relative to /VTKHDF.
};

/// Plans VTKHDF 2.0 temporal PolyData over the levels: one part that all steps share if the
/// connectivity never changes, otherwise one part for each step.
VtkhdfLayout vtkhdf_layout(std::span<const VtkhdfStep> steps);

/// Writes the group /VTKHDF; the arrays that the views show must exist.
void write_vtkhdf(DigestedFile& file, const VtkhdfLayout& layout, Compression compression);

/// Throws Error, which names the object, if /VTKHDF breaks a rule of the format or of VTK's reader.
/// It reads the offsets and Polygons/Offsets, but none of the big arrays.
void check_vtkhdf(const Hdf5File& file);

}  // namespace semigeo::io
