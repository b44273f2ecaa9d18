#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace semigeo::io {

/// One number for each vertex, and its name in files: "mean_curvature".
struct NamedScalars {
  std::string name;
  std::span<const float> values;  ///< (N) values.
};
/// The same for whole numbers: "part".
struct NamedIntegers {
  std::string name;
  std::span<const std::int64_t> values;  ///< (N) values.
};

/// A view of a mesh in somebody else's memory.
struct MeshView {
  std::span<const float> points;               ///< (N, 3), relative to origin
  std::span<const float> normals;              ///< (N, 3), or empty
  std::span<const std::int64_t> triangles;     ///< (F, 3), indices into points
  std::vector<NamedScalars> scalars;           ///< Vertex properties after position and normal.
  std::array<double, 3> origin = {0, 0, 0};    ///< Added to the points.
  std::span<const std::uint8_t> colours = {};  ///< (N, 3) red, green, blue in sRGB, or empty
  std::vector<NamedIntegers> integers = {};    ///< Vertex properties after the scalars.
};

/// Checks a mesh before a file of it is written. Throws std::invalid_argument if the shapes
/// disagree or a name is no single word of ASCII, and Error, which names the file, if a corner of a
/// triangle is no vertex.
void check_mesh(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
