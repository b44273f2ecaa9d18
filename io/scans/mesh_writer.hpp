#pragma once

#include <filesystem>

#include "io/scans/mesh_view.hpp"

namespace semigeo::io {

/// Writes the mesh as binary little-endian PLY: x y z (double if the origin is not zero, which
/// keeps map coordinates exact, otherwise float), nx ny nz, red green blue, the scalars, the
/// integers, and the faces. The file appears whole or not at all. Throws Error if the disk fails or
/// a number does not fit its type, and std::invalid_argument as `check_mesh` does.
void write_ply(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
