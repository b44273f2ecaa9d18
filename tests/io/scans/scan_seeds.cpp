#include "tests/io/scans/scan_seeds.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

#include "tests/io/scans/gltf_files.hpp"
#include "tests/io/scans/scan_files.hpp"
#include "tests/io/scans/vtk_files.hpp"

namespace semigeo::io {
namespace {

std::string grid_points(std::string_view before) {
  std::string text;
  for (int i = 0; i < 16; ++i)
    text +=
        std::string(before) + std::to_string(i % 4) + " " + std::to_string(i / 4) + ".5 -1e-1\n";
  return text;
}

Seed ascii_ply() {
  std::string text =
      "ply\nformat ascii 1.0\ncomment x\nelement face 3\nproperty uchar c\n"
      "property list uchar int vertex_indices\nelement vertex 16\nproperty float x\n"
      "property double y\nproperty list int short q\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "7 3 0 1 4\n8 4 0 1 5 4\n9 6 0 1 2 6 9 4\n";
  for (int i = 0; i < 16; ++i)
    text += std::to_string(i % 4) + " " + std::to_string(i / 4) + " 2 1 2 0.5\n";
  return {"ascii.ply", text + "8 0 4 1 5 -1 2 6 3\n"};
}

/// Groups of values on lines of their own, a value too many, and a line that means nothing.
Seed loose_ply() {
  std::string text =
      "ply\nformat ascii 1.0\nmade by x\nelement vertex 16\nproperty float x\nproperty int64 y\n"
      "property float z\nproperty uchar red\nelement face 3\n"
      "property list uint64 int64 vertex_indices\nend_header\n";
  for (int i = 0; i < 16; ++i)
    text += std::to_string(i % 4) + " " + std::to_string(i / 4) + " 2\n255\n";
  return {"loose.ply", text + "3 0 1 4 7\n4 0 1\n5 4\n6 0 1 2 6 9 4 8 8\n"};
}

Seed binary_ply(std::endian order) {
  const auto put = [&](auto value) { return bytes_of(value, order); };
  const bool little = order == std::endian::little;
  std::string file = std::string("ply\nformat binary_") + (little ? "little" : "big") +
                     "_endian 1.0\nelement vertex 16\nproperty float x\nproperty short y\n"
                     "property list uchar ushort q\nproperty double z\nelement face 2\n"
                     "property list uint int vertex_index\nproperty uchar r\nelement tristrips 1\n"
                     "property list int int vertex_indices\nend_header\n";
  for (int i = 0; i < 16; ++i)
    file += put(static_cast<float>(i % 4)) + put(static_cast<std::int16_t>(i / 4)) +
            put(std::uint8_t{1}) + put(std::uint16_t{9}) + put(0.5);
  file += put(3u) + put(0) + put(1) + put(4) + "r" + put(5u) + put(1) + put(2) + put(6) + put(5) +
          put(4) + "r" + put(5) + put(0) + put(4) + put(1) + put(-1) + put(5);
  return {little ? "little.ply" : "big.ply", file};
}

Seed binary_off() {
  const auto put = [](auto value) { return bytes_of(value, std::endian::big); };
  std::string file = "NOFF BINARY\n" + put(8) + put(2) + put(0);
  for (int i = 0; i < 8 * 6; ++i) file += put(static_cast<float>(i * i % 7));
  file += put(3) + put(0) + put(1) + put(2) + put(1) + put(0.5f);
  file += put(5) + put(0) + put(1) + put(2) + put(3) + put(4) + put(0);
  return {"binary.off", file};
}

Seed binary_stl() {
  std::string file = "solid but binary" + std::string(64, ' ') + bytes_of(4);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 12; ++k) file += bytes_of(static_cast<float>(i * k % 5));
    file += "ab";
  }
  return {"binary.stl", file};
}

Seed grid_ply() {
  std::string text =
      "ply\nformat ascii 1.0\nobj_info num_cols 4\nobj_info num_rows 4\nelement vertex 16\n"
      "property float x\nproperty float y\nproperty float z\nelement range_grid 16\n"
      "property list uchar int vertex_indices\nend_header\n" +
      grid_points("");
  for (int i = 0; i < 16; ++i) text += i == 5 ? "0\n" : "1 " + std::to_string(i) + "\n";
  return {"grid.ply", text};
}

/// A PCD of 4 x 4 points in each encoding.
Seed pcd(const std::string& data) {
  std::string file =
      "# x\nVERSION 0.7\nFIELDS x y z a\nSIZE 4 4 8 1\nTYPE F F F U\nCOUNT 1 1 1 2\n"
      "WIDTH 4\nHEIGHT 4\nVIEWPOINT 0 0 9 1 0 0 0\nPOINTS 16\nDATA " +
      data + "\n";
  std::vector<std::string> fields(4);
  for (int i = 0; i < 16; ++i) {
    const auto x = static_cast<float>(i % 4), y = static_cast<float>(i / 4);
    if (data == "ascii")
      file +=
          std::to_string(i % 4) + " " + std::to_string(i / 4) + (i == 6 ? " nan" : " 1") + " 7 7\n";
    if (data == "binary") file += bytes_of(x) + bytes_of(y) + bytes_of(1.0) + "ab";
    fields[0] += bytes_of(x);
    fields[1] += bytes_of(y);
    fields[2] += bytes_of(1.0);
    fields[3] += "ab";
  }
  if (data != "binary_compressed") return {data + ".pcd", file};
  std::string packed;
  for (const std::string& field : {fields[0], fields[1], fields[2]})
    for (std::size_t at = 0; at < field.size(); at += 32)
      packed += static_cast<char>(31) + field.substr(at, 32);
  packed += std::string(
      "\x01"
      "ab"
      "\xe0\x15\x01",
      6);  // 30 bytes, 2 back
  file += bytes_of(static_cast<std::uint32_t>(packed.size())) + bytes_of(16u * 18) + packed;
  return {data + ".pcd", file};
}

Seed ptx() {
  std::string text;
  for (int cloud = 0; cloud < 2; ++cloud)
    text +=
        "4\n4\n1 2 9\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 9 1\n" + grid_points("");
  return {"a.ptx", text};
}

/// Two instances of a mesh of three primitives: indexed, a strip with sparse elements, points.
GltfParts gltf_parts() {
  GltfParts parts = square_parts();
  const int places = parts.add_view(bytes_of_all(std::vector<std::uint16_t>{1, 2}));
  const int values = parts.add_view(bytes_of_all(std::vector<std::int8_t>{1, 2, 3, 4, 5, 6}));
  const std::string sparse =
      R"(,"sparse":{"count":2,"indices":{"componentType":5123,"bufferView":)" +
      std::to_string(places) + R"(},"values":{"bufferView":)" + std::to_string(values) + "}}";
  const std::vector<std::int8_t> quantised = {0, 0, 0, 9, 0, 0, 9, 9, 0, 0, 9, 0};
  const int strip = parts.add_numbers(5120, "VEC3", quantised, R"(,"normalized":true)" + sparse);
  parts.add_primitive(strip, -1, 5);
  parts.add_primitive(0, -1, 0);
  const std::size_t attributes = parts.primitives.find(R"("POSITION":)" + std::to_string(strip));
  parts.primitives.insert(attributes, R"("NORMAL":)" + std::to_string(strip) + ",");
  parts.nodes = R"({"children":[1,2],"rotation":[0,0,1,0]},{"mesh":0,"translation":[1,2,3]},)"
                R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,-1,0,5,6,7,1]})";
  return parts;
}

Seed vtk(bool binary) {
  VtkText file(binary, "3.0");
  file.line("DATASET POLYDATA").line("FIELD f 1").line("a 1 2 int").numbers(std::vector<int>{1, 2});
  file.line("POINTS 4 float").numbers(kSquare);
  file.line("LINES 1 3").numbers(std::vector<int>{2, 0, 1});
  file.line("TRIANGLE_STRIPS 1 5").numbers(std::vector<int>{4, 0, 1, 3, 2});
  file.line("POLYGONS 2 9").numbers(std::vector<int>{3, 0, 1, 2, 4, 0, 1, 2, 3});
  file.line("POINT_DATA 4").line("SCALARS s short").line("LOOKUP_TABLE t");
  file.numbers(std::vector<std::int16_t>(4, 1)).line("NORMALS n float");
  return {binary ? "binary.vtk" : "ascii.vtk", file.numbers(std::vector<float>(12, 1)).text};
}

Seed vtk_grid(bool binary) {
  VtkText file(binary, "5.1");
  file.line("DATASET UNSTRUCTURED_GRID").line("POINTS 4 float").numbers(kSquare);
  file.line("METADATA").line("INFORMATION 0").line("").line("CELLS 3 7");
  file.line("OFFSETS vtktypeint64").numbers(std::vector<std::int64_t>{0, 3, 7});
  file.line("CONNECTIVITY vtktypeint64").numbers(std::vector<std::int64_t>{0, 1, 2, 0, 1, 2, 3});
  file.line("CELL_TYPES 2").numbers(std::vector<int>{5, 9});
  return {binary ? "binary_grid.vtk" : "ascii_grid.vtk", file.text};
}

Seed vtp(const std::string& name, VtpWriter writer) {
  const std::string pieces = writer.piece() + writer.piece();
  return {name, writer.file(pieces)};
}

}  // namespace

std::vector<Seed> plain_seeds() {
  std::string facets = "solid a b\n";
  for (int i = 0; i < 4; ++i)
    facets +=
        " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 " +
        std::to_string(i) + "\n  endloop\n endfacet\n";
  const std::string obj =
      "# x\nmtllib a\n" + grid_points("v ") + "vt 0 0\nvn 0 0 1\nf 1 2 5\n" +
      "f 1/1 2/1 6/1 5/1\nf 1//1 2//1 \\\n3//1 7//1 10//1 5//1\nf -1 -2 -5\nl 1 2\n";
  const std::string off = "COFF # x\n16 3 0\n" + grid_points("") + "3 0 1 4\n4 0 1 5 4 255 0 0\n" +
                          "6 0 1 2 6 9 4 0.5\n";
  return {ascii_ply(),
          binary_ply(std::endian::little),
          binary_ply(std::endian::big),
          {"a.obj", obj},
          {"a.off", off},
          binary_off(),
          {"ascii.stl", facets + "endsolid a b\n"},
          binary_stl(),
          loose_ply(),
          grid_ply(),
          pcd("ascii"),
          pcd("binary"),
          pcd("binary_compressed"),
          ptx(),
          {"a.gltf", gltf_parts().gltf()},
          {"a.glb", gltf_parts().glb()},
          vtk(false),
          vtk(true),
          vtk_grid(false),
          vtk_grid(true),
          vtp("ascii.vtp", {}),
          vtp("binary.vtp", {.format = "binary", .wide_header = true, .compressed = true}),
          vtp("raw.vtp", {.format = "appended", .order = std::endian::big}),
          vtp("packed.vtp", {.format = "appended", .encoding = "base64", .compressed = true})};
}

}  // namespace semigeo::io
