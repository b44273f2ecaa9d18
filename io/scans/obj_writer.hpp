#pragma once

#include <filesystem>
#include <string>

#include "io/scans/mesh_view.hpp"

namespace semigeo::io {

/// Writes the mesh as Wavefront OBJ: v x y z, with red green blue between 0 and 1 behind it if the
/// mesh has colours, vn, and f a//a b//b c//c. Numbers are the shortest that read back as the same.
/// OBJ has no scalars, so they are left out. `comment` stands in the first line. The file appears
/// whole or not at all. Throws what `check_mesh` throws, and Error if the disk fails.
void write_obj(const std::filesystem::path& path, const MeshView& mesh, const std::string& comment);

}  // namespace semigeo::io
