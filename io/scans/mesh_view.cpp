#include "io/scans/mesh_view.hpp"

#include <algorithm>
#include <stdexcept>

#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

bool is_word(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 127; });
}

}  // namespace

void check_mesh(const std::filesystem::path& path, const MeshView& mesh) {
  const std::size_t vertices = mesh.points.size() / 3;
  const auto is_vector = [&mesh](std::size_t size) {
    return size == 0 || size == mesh.points.size();
  };
  bool fits = mesh.points.size() % 3 == 0 && mesh.triangles.size() % 3 == 0 &&
              is_vector(mesh.normals.size()) && is_vector(mesh.colours.size());
  for (const NamedScalars& scalars : mesh.scalars)
    fits = fits && scalars.values.size() == vertices && is_word(scalars.name);
  for (const NamedIntegers& integers : mesh.integers)
    fits = fits && integers.values.size() == vertices && is_word(integers.name);
  if (!fits)
    throw std::invalid_argument("a mesh to write: arrays of different lengths, or a bad name");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (mesh.triangles[i] < 0 || mesh.triangles[i] >= static_cast<std::int64_t>(vertices))
      throw Error(path, "face " + std::to_string(i / 3),
                  "refers to vertex " + std::to_string(mesh.triangles[i]) + " of " +
                      std::to_string(vertices));
}

}  // namespace semigeo::io
