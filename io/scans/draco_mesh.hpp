#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace semigeo::io {

/// A mesh that was compressed by Draco.
struct DracoMesh {
  std::vector<double> positions;       ///< Three coordinates for each vertex.
  std::vector<double> normals;         ///< As many, or none.
  std::vector<std::uint32_t> indices;  ///< Three for each triangle, each that of a vertex.
};

/// Decompresses a mesh. The attributes are told by the numbers that glTF has for them. Throws
/// std::runtime_error with the reason if the data is damaged, is no mesh, or has no such positions;
/// missing or damaged normals are none.
DracoMesh decode_draco(std::string_view bytes, std::int64_t positions,
                       std::optional<std::int64_t> normals);

}  // namespace semigeo::io
