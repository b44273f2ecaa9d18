#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace semigeo::io {

/// One number for each vertex, and the name of its PLY property: "mean_curvature".
struct NamedScalars {
  std::string name;
  std::span<const float> values;  ///< (N) values.
};

/// A view of a mesh in somebody else's memory.
struct MeshView {
  std::span<const float> points;             ///< (N, 3), relative to origin
  std::span<const float> normals;            ///< (N, 3), or empty
  std::span<const std::int64_t> triangles;   ///< (F, 3), indices into points
  std::vector<NamedScalars> scalars;         ///< Vertex properties after position and normal.
  std::array<double, 3> origin = {0, 0, 0};  ///< Added to the points.
};

/// Writes the mesh as binary little-endian PLY: x y z (double if the origin is not zero, which
/// keeps map coordinates exact, otherwise float), nx ny nz, the scalars, and the faces. The file
/// appears whole or not at all. Throws Error if the disk fails or an index is out of range, and
/// std::invalid_argument if the shapes disagree or a name is no single word.
void write_ply(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
