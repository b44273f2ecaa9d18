#include "io/scans/mesh_writer.hpp"

#include <limits>
#include <string>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {
namespace {

/// Returns a number as PLY's int. Throws Error if it does not fit.
std::int32_t ply_int(const OutputFile& output, std::int64_t value) {
  if (value < std::numeric_limits<std::int32_t>::min() ||
      value > std::numeric_limits<std::int32_t>::max())
    throw Error(output.path(), "", "would need " + std::to_string(value) + " as a PLY's int",
                "write a .npz or a .vtp");
  return static_cast<std::int32_t>(value);
}

std::string header(const MeshView& mesh) {
  std::string text = kPlyBegin;
  text += "element vertex " + std::to_string(mesh.points.size() / 3) + "\n";
  const std::string type = Placement(mesh.origin).ply_type();
  for (const char* name : {"x", "y", "z"}) text += "property " + type + " " + name + "\n";
  if (!mesh.normals.empty())
    for (const char* name : {"nx", "ny", "nz"})
      text += std::string("property float ") + name + "\n";
  if (!mesh.colours.empty())
    for (const char* name : {"red", "green", "blue"})
      text += std::string("property uchar ") + name + "\n";
  for (const NamedScalars& scalars : mesh.scalars) text += "property float " + scalars.name + "\n";
  for (const NamedIntegers& integers : mesh.integers)
    text += "property int " + integers.name + "\n";
  text += "element face " + std::to_string(mesh.triangles.size() / 3) + "\n";
  return text + "property list uchar int vertex_indices\nend_header\n";
}

void write_vertices(OutputFile& output, const MeshView& mesh) {
  const Placement placement(mesh.origin);
  for (std::size_t vertex = 0; vertex < mesh.points.size() / 3; ++vertex) {
    placement.place(&mesh.points[3 * vertex], [&](auto coordinate) { output.number(coordinate); });
    if (!mesh.normals.empty())
      for (std::size_t axis = 0; axis < 3; ++axis) output.number(mesh.normals[3 * vertex + axis]);
    if (!mesh.colours.empty())
      for (std::size_t i = 0; i < 3; ++i) output.number(mesh.colours[3 * vertex + i]);
    for (const NamedScalars& scalars : mesh.scalars) output.number(scalars.values[vertex]);
    for (const NamedIntegers& integers : mesh.integers)
      output.number(ply_int(output, integers.values[vertex]));
  }
}

void write_faces(OutputFile& output, const MeshView& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % 3 == 0) output.number(std::uint8_t{3});
    output.number(ply_int(output, mesh.triangles[i]));
  }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  check_mesh(path, mesh);
  OutputFile output(path);
  output.text(header(mesh));
  write_vertices(output, mesh);
  write_faces(output, mesh);
  output.commit();
}

}  // namespace semigeo::io
