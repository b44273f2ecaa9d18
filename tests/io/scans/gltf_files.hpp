#pragma once

#include <bit>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/base64.hpp"
#include "tests/io/scans/scan_files.hpp"

/// Files of glTF that are made by hand.
namespace semigeo::io {

/// Returns the bytes as Base64, with padding.
inline std::string base64(std::string_view bytes) {
  return base64(std::as_bytes(std::span(bytes)));
}

/// Returns the bytes of numbers, one behind the other.
template <typename Number>
std::string bytes_of_all(const std::vector<Number>& numbers,
                         std::endian order = std::endian::little) {
  std::string bytes;
  for (const Number number : numbers) bytes += bytes_of(number, order);
  return bytes;
}

/// Returns a binary glTF file of JSON and a chunk of bytes.
inline std::string glb(std::string json, std::string bytes) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  const auto u32 = [](std::size_t number) { return bytes_of(static_cast<std::uint32_t>(number)); };
  return "glTF" + u32(2) + u32(12 + 8 + json.size() + 8 + bytes.size()) + u32(json.size()) +
         "JSON" + json + u32(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

/// Builds the JSON and the bytes of a file with one mesh of one primitive, unless it is changed.
struct GltfParts {
  std::string bytes;       ///< Of buffer 0.
  std::string views;       ///< Elements of bufferViews, separated by commas.
  std::string accessors;   ///< Elements of accessors.
  std::string primitives;  ///< Elements of the primitives of mesh 0.
  std::string nodes = R"({"mesh":0})";
  std::string scenes = R"("scene":0,"scenes":[{"nodes":[0]}],)";
  std::string more;  ///< Other members of the file, each with a comma behind it.
  int view_count = 0, accessor_count = 0;

  /// Adds bytes with a bufferView of their own and returns its number.
  int add_view(std::string_view data, const std::string& members = "") {
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    add(views, R"({"buffer":0,"byteOffset":)" + std::to_string(bytes.size()) + R"(,"byteLength":)" +
                   std::to_string(data.size()) + members + "}");
    bytes += data;
    return view_count++;
  }
  /// Adds an accessor and returns its number.
  int add_accessor(int component_type, std::size_t count, const std::string& type,
                   const std::string& members) {
    add(accessors, R"({"componentType":)" + std::to_string(component_type) + R"(,"count":)" +
                       std::to_string(count) + R"(,"type":")" + type + "\"" + members + "}");
    return accessor_count++;
  }
  /// Adds an accessor to bytes of its own.
  template <typename Number>
  int add_numbers(int component_type, const std::string& type, const std::vector<Number>& numbers,
                  const std::string& members = "") {
    const std::size_t components = type == "VEC3" ? 3 : 1;
    const int view = add_view(bytes_of_all(numbers));
    return add_accessor(component_type, numbers.size() / components, type,
                        R"(,"bufferView":)" + std::to_string(view) + members);
  }
  /// Adds a primitive. Without indices, give -1; without a mode, -1.
  void add_primitive(int positions, int indices = -1, int mode = -1,
                     const std::string& members = "") {
    std::string text = R"({"attributes":{"POSITION":)" + std::to_string(positions) + "}";
    if (indices >= 0) text += R"(,"indices":)" + std::to_string(indices);
    if (mode >= 0) text += R"(,"mode":)" + std::to_string(mode);
    add(primitives, text + members + "}");
  }

  std::string json(const std::string& uri = "") const {
    return R"({"asset":{"version":"2.0"},)" + scenes + more + R"("nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[)" + primitives + R"(]}],"accessors":[)" + accessors +
           R"(],"bufferViews":[)" + views + R"(],"buffers":[{"byteLength":)" +
           std::to_string(bytes.size()) + uri + "}]}";
  }
  /// Returns the file as JSON with the bytes in it.
  std::string gltf() const {
    return json(R"(,"uri":"data:application/octet-stream;base64,)" + base64(bytes) + "\"");
  }
  std::string glb() const { return io::glb(json(), bytes); }

 private:
  static void add(std::string& list, const std::string& element) {
    list += (list.empty() ? "" : ",") + element;
  }
};

/// The corners of a square in the plane z = 0, in order round it.
inline const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

/// A square of two triangles.
inline GltfParts square_parts() {
  GltfParts parts;
  const int positions = parts.add_numbers(5126, "VEC3", kSquare);
  const int indices =
      parts.add_numbers(5123, "SCALAR", std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3});
  parts.add_primitive(positions, indices);
  return parts;
}

}  // namespace semigeo::io
