#pragma once

#include <filesystem>

#include "io/scans/mesh_view.hpp"

namespace semigeo::io {

/// Writes the mesh as binary STL: triangles with their normals, as floats. STL has nothing else,
/// and floats lose map coordinates, so the origin is left out. The file appears whole or not at
/// all. Throws what `check_mesh` throws, and Error if the disk fails or there are more triangles
/// than 32 bits count.
void write_stl(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
