#include "io/scans/mesh_writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {
namespace {

bool is_word(const std::string& name) {
  return !name.empty() &&
         std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c < 127; });
}

void check_shapes(const MeshView& mesh) {
  const std::size_t vertices = mesh.points.size() / 3;
  bool fits = mesh.points.size() % 3 == 0 && mesh.triangles.size() % 3 == 0 &&
              (mesh.normals.empty() || mesh.normals.size() == mesh.points.size());
  for (const NamedScalars& scalars : mesh.scalars)
    fits = fits && scalars.values.size() == vertices && is_word(scalars.name);
  if (!fits) throw std::invalid_argument("write_ply: arrays of different lengths, or a bad name");
}

std::string header(const MeshView& mesh) {
  std::string text = kPlyBegin;
  text += "element vertex " + std::to_string(mesh.points.size() / 3) + "\n";
  const std::string type = Placement(mesh.origin).ply_type();
  for (const char* name : {"x", "y", "z"}) text += "property " + type + " " + name + "\n";
  if (!mesh.normals.empty())
    for (const char* name : {"nx", "ny", "nz"})
      text += std::string("property float ") + name + "\n";
  for (const NamedScalars& scalars : mesh.scalars) text += "property float " + scalars.name + "\n";
  text += "element face " + std::to_string(mesh.triangles.size() / 3) + "\n";
  return text + "property list uchar int vertex_indices\nend_header\n";
}

void write_vertices(OutputFile& output, const MeshView& mesh) {
  const Placement placement(mesh.origin);
  for (std::size_t vertex = 0; vertex < mesh.points.size() / 3; ++vertex) {
    placement.place(&mesh.points[3 * vertex], [&](auto coordinate) { output.number(coordinate); });
    if (!mesh.normals.empty())
      for (std::size_t axis = 0; axis < 3; ++axis) output.number(mesh.normals[3 * vertex + axis]);
    for (const NamedScalars& scalars : mesh.scalars) output.number(scalars.values[vertex]);
  }
}

void write_faces(OutputFile& output, const MeshView& mesh) {
  const auto vertices = static_cast<std::int64_t>(mesh.points.size() / 3);
  const std::int64_t end =
      std::min<std::int64_t>(vertices, std::numeric_limits<std::int32_t>::max());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::int64_t corner = mesh.triangles[i];
    if (corner < 0 || corner >= end)
      throw Error(output.path(), "face " + std::to_string(i / 3),
                  "refers to vertex " + std::to_string(corner) + " of " + std::to_string(vertices));
    if (i % 3 == 0) output.number(std::uint8_t{3});
    output.number(static_cast<std::int32_t>(corner));
  }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  check_shapes(mesh);
  OutputFile output(path);
  output.text(header(mesh));
  write_vertices(output, mesh);
  write_faces(output, mesh);
  output.commit();
}

}  // namespace semigeo::io
