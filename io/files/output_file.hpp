#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/descriptor.hpp"
#include "io/files/atomic_file.hpp"

namespace semigeo::io {

/// A file that appears whole or not at all, written from its beginning to its end. Every failure of
/// the disk is an Error that names it.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.final_path(); }

  void text(std::string_view bytes) { add(bytes.data(), bytes.size()); }

  /// Writes a number as bytes, little endian.
  template <typename Number>
  void number(Number value) {
    std::array<char, sizeof value> bytes;
    std::memcpy(bytes.data(), &value, bytes.size());
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    add(bytes.data(), bytes.size());
  }

  /// Writes a number as text: the shortest that reads back as the same number, in any locale.
  template <typename Number>
  void decimal(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    add(digits.data(), static_cast<std::size_t>(end - digits.data()));
  }

  /// Gives the file its name. It must be called last.
  void commit();
  /// Gives the file its name as AtomicFile::commit_unsynced does. It must be called last.
  void commit_unsynced();

 private:
  void add(const char* bytes, std::size_t count);
  void flush();
  void close();
  [[noreturn]] void fail(const char* problem) const;

  AtomicFile file_;
  engine::Descriptor descriptor_;  // after file_, so that it is closed before it goes
  std::vector<char> buffer_;
};

/// The text at the beginning of every PLY that semigeo writes.
inline constexpr const char* kPlyBegin =
    "ply\nformat binary_little_endian 1.0\ncomment written by semigeo\n";

/// Adds the origin to points that are stored relative to it. The sums are doubles if the origin is
/// not zero, which keeps map coordinates exact; otherwise the floats stay as they are.
class Placement {
 public:
  explicit Placement(const std::array<double, 3>& origin)
      : origin_(origin), far_(origin != std::array<double, 3>{}) {}

  const char* ply_type() const { return far_ ? "double" : "float"; }

  /// Calls put(coordinate) for x, y and z.
  template <typename Put>
  void place(const float* point, const Put& put) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (far_) {
        put(point[axis] + origin_[axis]);
      } else {
        put(point[axis]);
      }
    }
  }

 private:
  std::array<double, 3> origin_;
  bool far_;
};

}  // namespace semigeo::io
