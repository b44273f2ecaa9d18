#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace semigeo::io {

/// One number per vertex under the name of a PLY property: "mean_curvature".
struct NamedScalars {
  std::string name;
  std::span<const float> values;  ///< (N)
};

/// A mesh in somebody else's memory, as write_ply takes it.
struct MeshView {
  std::span<const float> points;             ///< (N, 3), relative to origin
  std::span<const float> normals;            ///< (N, 3), or empty
  std::span<const std::int64_t> triangles;   ///< (F, 3), indices into points
  std::vector<NamedScalars> scalars;         ///< vertex properties after position and normal
  std::array<double, 3> origin = {0, 0, 0};  ///< added to the points
};

/// Writes the mesh as binary little-endian PLY: x y z (double if the origin is not zero, which
/// keeps map coordinates exact, else float), nx ny nz, the scalars, and the faces. The file appears
/// whole or not at all. An `Error` when the disk fails or an index is out of range;
/// std::invalid_argument when the shapes disagree or a name is no single word.
void write_ply(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
