#pragma once

#include <filesystem>
#include <string>

#include "io/scans/mesh_view.hpp"

namespace semigeo::io {

/// Writes the mesh as binary glTF 2.0: POSITION, NORMAL, COLOR_0, and each scalar as an attribute
/// with its name in capitals behind a "_" (_MEAN_CURVATURE). The origin is the translation of the
/// node. glTF has metres: the node's scale is that of `unit` ("mm", "cm", "m", "um"), and 1 for
/// other units; integers are left out. The file appears whole or not at all. Throws what
/// `check_mesh` throws, and Error if the disk fails, the mesh is empty or would need more than 4
/// GB.
void write_glb(const std::filesystem::path& path, const MeshView& mesh, const std::string& unit);

}  // namespace semigeo::io
