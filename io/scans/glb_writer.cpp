#include "io/scans/glb_writer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {
namespace {

// Numbers of the glTF 2.0 specification, 3.6 and 3.7.
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexBuffer = 34962;
constexpr int kIndexBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

/// Returns a number of bytes as a multiple of 4.
std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

/// The head of a GLB: views of its bytes, one after the other, and accessors of them.
class Head {
 public:
  /// Adds an array and returns the number of its accessor.
  int add(std::uint64_t bytes, std::uint64_t count, int component, const char* type, int target) {
    json_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_}, {"byteLength", bytes}, {"target", target}});
    json_["accessors"].push_back({{"bufferView", json_["bufferViews"].size() - 1},
                                  {"componentType", component},
                                  {"count", count},
                                  {"type", type}});
    bytes_ += padded(bytes);
    return static_cast<int>(json_["accessors"].size()) - 1;
  }
  nlohmann::json& json() { return json_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  nlohmann::json json_;
  std::uint64_t bytes_ = 0;
};

/// Returns the length of a unit in metres; 1 if it is unknown.
double metres_of(const std::string& unit) {
  for (const auto& [name, metres] :
       {std::pair("mm", 1e-3), std::pair("cm", 1e-2), std::pair("um", 1e-6)})
    if (unit == name) return metres;
  return 1;
}

/// Returns "_MEAN_CURVATURE" for "mean_curvature".
std::string attribute_name(std::string name) {
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return "_" + name;
}

void add_bounds(nlohmann::json& accessor, std::span<const float> points) {
  std::array<float, 3> low = {points[0], points[1], points[2]};
  std::array<float, 3> high = low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], points[i]);
    high[i % 3] = std::max(high[i % 3], points[i]);
  }
  accessor["min"] = low;
  accessor["max"] = high;
}

Head head_of(const MeshView& mesh, const std::string& unit) {
  Head head;
  const std::uint64_t vertices = mesh.points.size() / 3;
  nlohmann::json attributes;
  attributes["POSITION"] =
      head.add(mesh.points.size_bytes(), vertices, kFloat, "VEC3", kVertexBuffer);
  add_bounds(head.json()["accessors"][0], mesh.points);
  if (!mesh.normals.empty())
    attributes["NORMAL"] =
        head.add(mesh.normals.size_bytes(), vertices, kFloat, "VEC3", kVertexBuffer);
  if (!mesh.colours.empty()) {  // four bytes a vertex, as accessors must be aligned
    const int colour = head.add(4 * vertices, vertices, kUnsignedByte, "VEC4", kVertexBuffer);
    head.json()["accessors"][colour]["normalized"] = true;
    attributes["COLOR_0"] = colour;
  }
  for (const NamedScalars& scalars : mesh.scalars)
    attributes[attribute_name(scalars.name)] =
        head.add(scalars.values.size_bytes(), vertices, kFloat, "SCALAR", kVertexBuffer);
  const int indices = head.add(mesh.triangles.size() * sizeof(std::uint32_t), mesh.triangles.size(),
                               kUnsignedInt, "SCALAR", kIndexBuffer);
  nlohmann::json& json = head.json();
  json["asset"] = {{"version", "2.0"}, {"generator", "semigeo"}};
  json["buffers"] = {{{"byteLength", head.bytes()}}};
  json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
  nlohmann::json node = {{"mesh", 0}, {"extras", {{"length_unit", unit}}}};
  const double metres = metres_of(unit);
  if (metres != 1) node["scale"] = {metres, metres, metres};
  if (mesh.origin != std::array<double, 3>{})
    node["translation"] = {metres * mesh.origin[0], metres * mesh.origin[1],
                           metres * mesh.origin[2]};
  json["nodes"] = nlohmann::json::array({node});
  json["scenes"] = {{{"nodes", {0}}}};
  json["scene"] = 0;
  return head;
}

/// Returns the colour of one channel as glTF has it: light, not sRGB.
std::uint8_t linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  const double light = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return static_cast<std::uint8_t>(std::lround(255 * light));
}

void write_arrays(OutputFile& output, const MeshView& mesh) {
  const auto put = [&output](std::span<const float> numbers) {
    for (const float number : numbers) output.number(number);
  };
  put(mesh.points);
  put(mesh.normals);
  for (std::size_t i = 0; i < mesh.colours.size(); ++i) {
    output.number(linear(mesh.colours[i]));
    if (i % 3 == 2) output.number(std::uint8_t{255});
  }
  for (const NamedScalars& scalars : mesh.scalars) put(scalars.values);
  for (const std::int64_t corner : mesh.triangles)
    output.number(static_cast<std::uint32_t>(corner));
}

}  // namespace

void write_glb(const std::filesystem::path& path, const MeshView& mesh, const std::string& unit) {
  check_mesh(path, mesh);
  if (mesh.triangles.empty()) throw Error(path, "", "glTF has no empty meshes");
  Head head = head_of(mesh, unit);
  std::string json = head.json().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  json.resize(padded(json.size()), ' ');
  constexpr std::uint64_t kHeads = 12 + 8 + 8;
  const std::uint64_t all = kHeads + json.size() + head.bytes();
  if (all > std::numeric_limits<std::uint32_t>::max())
    throw Error(path, "", "would need more than 4 GB, which glTF cannot have", "write a .ply");
  OutputFile output(path);
  for (const std::uint64_t number : {std::uint64_t{kMagic}, std::uint64_t{2}, all,
                                     std::uint64_t{json.size()}, std::uint64_t{kJsonChunk}})
    output.number(static_cast<std::uint32_t>(number));
  output.text(json);
  output.number(static_cast<std::uint32_t>(head.bytes()));
  output.number(kBinaryChunk);
  write_arrays(output, mesh);
  output.commit();
}

}  // namespace semigeo::io
