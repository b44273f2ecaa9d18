#include "io/scans/draco_mesh.hpp"

#include <draco/compression/decode.h>

#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

namespace semigeo::io {
namespace {

/// Returns the three components of an attribute for each vertex, or nothing if it has not got them.
std::vector<double> components_of(const draco::Mesh& mesh, std::int64_t id) {
  if (id < 0 || id > std::numeric_limits<std::int32_t>::max()) return {};
  const draco::PointAttribute* const attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
  if (attribute == nullptr || attribute->num_components() != 3) return {};
  if (!attribute->is_mapping_identity() && attribute->indices_map_size() < mesh.num_points())
    return {};
  std::vector<double> values(3 * std::size_t{mesh.num_points()});
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const draco::AttributeValueIndex at = attribute->mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute->size() ||
        !attribute->ConvertValue<double>(at, 3, &values[3 * std::size_t{i}]))
      return {};
  }
  return values;
}

DracoMesh decode(std::string_view bytes, std::int64_t positions,
                 std::optional<std::int64_t> normals) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh result;
  result.positions = components_of(*mesh, positions);
  if (result.positions.empty()) throw std::runtime_error("it has no positions");
  if (normals) result.normals = components_of(*mesh, *normals);
  result.indices.reserve(3 * std::size_t{mesh->num_faces()});
  for (std::uint32_t f = 0; f < mesh->num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh->face(draco::FaceIndex(f))) {
      if (corner.value() >= mesh->num_points())
        throw std::runtime_error("a face refers to a vertex that is not there");
      result.indices.push_back(corner.value());
    }
  return result;
}

}  // namespace

DracoMesh decode_draco(std::string_view bytes, std::int64_t positions,
                       std::optional<std::int64_t> normals) {
  try {
    return decode(bytes, positions, normals);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("it would need more memory than there is");
  } catch (const std::length_error&) {
    throw std::runtime_error("it would need more memory than there is");
  }
}

}  // namespace semigeo::io
