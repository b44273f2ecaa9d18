#include "io/mesh_writer.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "io/atomic_file.hpp"
#include "io/error.hpp"

namespace semigeo::io {
namespace {

/// Bytes on their way into a file. Every failure of the disk is an Error that names `shown_path`.
class Output {
 public:
  Output(const std::filesystem::path& path, std::filesystem::path shown_path)
      : shown_path_(std::move(shown_path)), file_(std::fopen(path.c_str(), "wb")) {
    if (!file_) fail("cannot be created");
    buffer_.reserve(kBufferBytes + 64);
  }

  void text(std::string_view bytes) { add(bytes.data(), bytes.size()); }

  template <typename Number>
  void number(Number value) {
    std::array<char, sizeof value> bytes;
    std::memcpy(bytes.data(), &value, bytes.size());
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    add(bytes.data(), bytes.size());
  }

  /// Must be called last: only the closing reports the last of the failures.
  void close() {
    flush();
    if (std::fclose(file_.release()) != 0) fail("cannot be written");
  }

 private:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void add(const char* bytes, std::size_t count) {
    buffer_.insert(buffer_.end(), bytes, bytes + count);
    if (buffer_.size() >= kBufferBytes) flush();
  }
  void flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) != buffer_.size())
      fail("cannot be written");
    buffer_.clear();
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(shown_path_, "", problem + ": " + std::generic_category().message(errno),
                "check the folder, its permissions and the free space");
  }

  std::filesystem::path shown_path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
};

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

bool has_origin(const MeshView& mesh) {
  return std::any_of(mesh.origin.begin(), mesh.origin.end(), [](double o) { return o != 0; });
}

std::string header(const MeshView& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment written by semigeo\n";
  text += "element vertex " + std::to_string(mesh.points.size() / 3) + "\n";
  const std::string type = has_origin(mesh) ? "double" : "float";
  for (const char* name : {"x", "y", "z"}) text += "property " + type + " " + name + "\n";
  if (!mesh.normals.empty())
    for (const char* name : {"nx", "ny", "nz"})
      text += std::string("property float ") + name + "\n";
  for (const NamedScalars& scalars : mesh.scalars) text += "property float " + scalars.name + "\n";
  text += "element face " + std::to_string(mesh.triangles.size() / 3) + "\n";
  return text + "property list uchar int vertex_indices\nend_header\n";
}

void write_vertices(Output& output, const MeshView& mesh) {
  const bool wide = has_origin(mesh);
  for (std::size_t vertex = 0; vertex < mesh.points.size() / 3; ++vertex) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float coordinate = mesh.points[3 * vertex + axis];
      if (wide) {
        output.number(coordinate + mesh.origin[axis]);
      } else {
        output.number(coordinate);
      }
    }
    if (!mesh.normals.empty())
      for (std::size_t axis = 0; axis < 3; ++axis) output.number(mesh.normals[3 * vertex + axis]);
    for (const NamedScalars& scalars : mesh.scalars) output.number(scalars.values[vertex]);
  }
}

void write_faces(Output& output, const std::filesystem::path& path, const MeshView& mesh) {
  const auto vertices = static_cast<std::int64_t>(mesh.points.size() / 3);
  const std::int64_t end =
      std::min<std::int64_t>(vertices, std::numeric_limits<std::int32_t>::max());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::int64_t corner = mesh.triangles[i];
    if (corner < 0 || corner >= end)
      throw Error(path, "face " + std::to_string(i / 3),
                  "refers to vertex " + std::to_string(corner) + " of " + std::to_string(vertices));
    if (i % 3 == 0) output.number(std::uint8_t{3});
    output.number(static_cast<std::int32_t>(corner));
  }
}

}  // namespace

void write_ply(const std::filesystem::path& path, const MeshView& mesh) {
  check_shapes(mesh);
  AtomicFile file(path);
  Output output(file.temporary_path(), path);
  output.text(header(mesh));
  write_vertices(output, mesh);
  write_faces(output, path, mesh);
  output.close();
  file.commit();
}

}  // namespace semigeo::io
