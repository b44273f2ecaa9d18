#pragma once

#include <filesystem>

#include "io/scans/mesh_view.hpp"

namespace semigeo::io {

/// Writes the mesh as VTK XML PolyData with appended raw arrays: points (Float64 if the origin is
/// not zero), Normals, colours as "colours", each scalar and integer under its name, and triangles.
/// The file appears whole or not at all. Throws what `check_mesh` throws, and Error if the disk
/// fails.
void write_vtp(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace semigeo::io
