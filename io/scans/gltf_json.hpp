#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// An object in the JSON of a glTF file, and its place there: "meshes[0].primitives[1]". What is
/// not of the expected kind is an Error that names the place. The JSON and the path must outlive
/// the object.
class GltfObject {
 public:
  GltfObject(const std::filesystem::path& path, const nlohmann::json& value, std::string place);

  const std::string& place() const { return place_; }
  /// Returns whether there is a member of this name.
  bool has(const char* key) const;
  /// Returns a member that is an object.
  GltfObject object(const char* key) const;
  /// Returns the number of elements of a member that is an array. An absent one has none.
  std::int64_t size(const char* key) const;
  /// Returns an element of an array of objects. `index` may be any number.
  GltfObject item(const char* key, std::int64_t index) const;
  /// Returns an element of an array of whole numbers that are not negative.
  std::int64_t index(const char* key, std::int64_t element) const;
  /// Returns an element of an array of texts.
  std::string text(const char* key, std::int64_t element) const;
  /// Returns a whole number that is not negative. Without a `fallback`, it must be there.
  std::int64_t integer(const char* key, std::optional<std::int64_t> fallback = {}) const;
  /// Returns a text, or nothing if it is absent.
  std::optional<std::string_view> text(const char* key) const;
  /// Returns a truth value, which is false if it is absent.
  bool flag(const char* key) const;
  /// Returns an array of Size numbers, or nothing if it is absent.
  template <std::size_t Size>
  std::optional<std::array<double, Size>> numbers(const char* key) const {
    std::array<double, Size> values;
    if (!has(key)) return std::nullopt;
    read_numbers(key, values.data(), Size);
    return values;
  }

  /// Throws the Error of this place.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) const;

 private:
  const nlohmann::json& array(const char* key) const;
  void read_numbers(const char* key, double* values, std::size_t size) const;
  std::int64_t to_index(const nlohmann::json& number, const std::string& name) const;
  std::string name_of(std::string_view key) const;

  const std::filesystem::path* path_;
  const nlohmann::json* value_;
  std::string place_;
};

/// Returns the references of buffers to other files, of a source at its start. Only the first
/// kMostCompanions buffers are looked at, of JSON of at most kMostCompanionJson bytes.
std::vector<std::string> gltf_references(ByteSource& source);

}  // namespace semigeo::io
