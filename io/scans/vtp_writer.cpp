#include "io/scans/vtp_writer.hpp"

#include <functional>
#include <string>
#include <utility>

#include "io/files/output_file.hpp"

namespace semigeo::io {
namespace {

/// An array of a VTP: what its head says, and how its numbers are written.
struct VtpArray {
  std::string name;
  std::string type;
  int components;
  std::uint64_t bytes;
  std::function<void(OutputFile&)> write;
};

template <typename Number>
VtpArray array_of(const std::string& name, const char* type, int components,
                  std::span<const Number> numbers) {
  return {name, type, components, numbers.size_bytes(), [numbers](OutputFile& output) {
            for (const Number number : numbers) output.number(number);
          }};
}

VtpArray points_of(const MeshView& mesh) {
  const Placement placement(mesh.origin);
  const bool wide = std::string(placement.ply_type()) == "double";
  return {"Points", wide ? "Float64" : "Float32", 3,
          mesh.points.size() * (wide ? sizeof(double) : sizeof(float)),
          [&mesh, placement](OutputFile& output) {
            for (std::size_t i = 0; i < mesh.points.size(); i += 3)
              placement.place(&mesh.points[i], [&](auto number) { output.number(number); });
          }};
}

/// Returns the arrays of vertices besides their points.
std::vector<VtpArray> vertex_arrays(const MeshView& mesh) {
  std::vector<VtpArray> arrays;
  if (!mesh.normals.empty()) arrays.push_back(array_of("Normals", "Float32", 3, mesh.normals));
  if (!mesh.colours.empty()) arrays.push_back(array_of("colours", "UInt8", 3, mesh.colours));
  for (const NamedScalars& scalars : mesh.scalars)
    arrays.push_back(array_of(scalars.name, "Float32", 1, scalars.values));
  for (const NamedIntegers& integers : mesh.integers)
    arrays.push_back(array_of(integers.name, "Int64", 1, integers.values));
  return arrays;
}

VtpArray offsets_of(const MeshView& mesh) {
  const std::size_t triangles = mesh.triangles.size() / 3;
  return {"offsets", "Int64", 1, triangles * sizeof(std::int64_t), [triangles](OutputFile& output) {
            for (std::size_t i = 1; i <= triangles; ++i)
              output.number(static_cast<std::int64_t>(3 * i));
          }};
}

/// Writes the heads of arrays, and counts the bytes behind which the next array begins.
void write_heads(OutputFile& output, const std::vector<VtpArray>& arrays, std::uint64_t& offset) {
  for (const VtpArray& array : arrays) {
    output.text("        <DataArray type=\"" + array.type + "\" Name=\"" + array.name +
                "\" NumberOfComponents=\"" + std::to_string(array.components) +
                "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n");
    offset += sizeof(std::uint64_t) + array.bytes;
  }
}

/// Returns the name so that it may stand in an attribute of XML.
std::string escaped(const std::string& name) {
  std::string result;
  for (const char c : name) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const MeshView& mesh) {
  check_mesh(path, mesh);
  const std::vector<VtpArray> points = {points_of(mesh)};
  std::vector<VtpArray> vertex = vertex_arrays(mesh);
  for (VtpArray& array : vertex) array.name = escaped(array.name);
  const std::vector<VtpArray> polygons = {array_of("connectivity", "Int64", 1, mesh.triangles),
                                          offsets_of(mesh)};
  OutputFile output(path);
  output.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <PolyData>\n    <Piece "
      "NumberOfPoints=\"" +
      std::to_string(mesh.points.size() / 3) +
      "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
      std::to_string(mesh.triangles.size() / 3) + "\">\n");
  std::uint64_t offset = 0;
  const auto section = [&](const char* name, const std::vector<VtpArray>& arrays) {
    output.text(std::string("      <") + name + ">\n");
    write_heads(output, arrays, offset);
    output.text(std::string("      </") + name + ">\n");
  };
  section("PointData", vertex);
  section("Points", points);
  section("Polys", polygons);
  output.text("    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n   _");
  for (const auto* arrays : {&std::as_const(vertex), &points, &polygons})
    for (const VtpArray& array : *arrays) {
      output.number(array.bytes);
      array.write(output);
    }
  output.text("\n  </AppendedData>\n</VTKFile>\n");
  output.commit();
}

}  // namespace semigeo::io
