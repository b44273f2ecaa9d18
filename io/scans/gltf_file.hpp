#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_source.hpp"
#include "io/scans/gltf_json.hpp"

namespace semigeo::io {

/// Bytes of a buffer that was decoded, or of the file itself.
struct GltfBytes {
  std::string_view bytes;
  std::shared_ptr<const std::string> keeper = {};  ///< Keeps the bytes of a decoded buffer.
};

/// The buffers that were decoded and used last. A file may have a thousand of them.
class DecodedBuffers {
 public:
  /// The bytes that are kept, besides those of the buffer that was used last.
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20;

  /// Returns the buffer of this number. Calls `decode`, which returns its bytes, if it is not kept.
  template <typename Decode>
  std::shared_ptr<const std::string> get(std::int64_t index, const Decode& decode) {
    const auto found = std::ranges::find(kept_, index, &Kept::index);
    if (found != kept_.end()) {
      std::rotate(kept_.begin(), found, found + 1);
    } else {
      kept_.insert(kept_.begin(), Kept{index, std::make_shared<const std::string>(decode())});
      drop();
    }
    return kept_.front().bytes;
  }
  /// Returns the bytes that are kept.
  std::size_t bytes() const;

 private:
  struct Kept {
    std::int64_t index;
    std::shared_ptr<const std::string> bytes;
  };
  void drop();

  std::vector<Kept> kept_;  ///< The one that was used last comes first.
};

/// A glTF 2.0 file in memory: JSON, or binary (.glb) with JSON and a chunk of bytes in it, and the
/// buffers of it in files beside it (companions.hpp), once they are needed. Gives the elements of
/// its accessors. Everything is checked before it is read or reserved, and what is wrong is an
/// Error that names the object of the JSON.
class GltfFile {
 public:
  /// Reads the source to its end, or a binary file to the end that it declares.
  explicit GltfFile(ByteSource& source);
  ~GltfFile();
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  /// Returns whether the file is binary glTF.
  bool is_binary() const { return binary_; }
  /// Returns the whole of the JSON.
  GltfObject root() const;
  /// Returns the coordinates of an accessor of positions, three for each.
  std::vector<double> positions(std::int64_t accessor);
  /// Returns the numbers of an accessor of indices.
  std::vector<std::uint32_t> indices(std::int64_t accessor);
  /// Returns the bytes of a bufferView.
  GltfBytes view_bytes(std::int64_t view);
  /// Returns whether an accessor has elements of its own.
  bool has_elements(std::int64_t accessor) const;
  /// Returns the largest number that an accessor of indices could hold.
  std::uint32_t largest_index(std::int64_t accessor) const;

 private:
  /// The types of components, by their numbers in the file.
  enum class Type : std::int64_t {
    kByte = 5120,
    kUnsignedByte = 5121,
    kShort = 5122,
    kUnsignedShort = 5123,
    kUnsignedInt = 5125,
    kFloat = 5126
  };
  /// Numbers that follow each other in a buffer with a constant stride.
  struct Elements {
    const char* data = nullptr;
    std::int64_t count = 0;
    std::int64_t stride = 0;
    std::int64_t components = 1;
    Type type = Type::kFloat;
    bool normalized = false;
  };

  std::string_view read_binary(ByteSource& source);
  void parse(std::string_view text);
  void check_extensions() const;
  GltfBytes buffer(std::int64_t index);
  std::string decode_uri(const GltfObject& buffer, std::string_view uri) const;
  std::string read_companion(const GltfObject& buffer, std::string_view uri) const;
  std::int64_t bytes_of_buffers();
  /// Finds the elements in the bufferView that `owner`, an accessor or a part of one, refers to.
  /// They are valid as long as what is returned.
  [[nodiscard]] GltfBytes locate(const GltfObject& owner, Elements& elements);
  template <typename Number>
  std::vector<Number> read(const GltfObject& accessor, Elements elements);
  template <typename Number>
  void replace_sparse(const GltfObject& sparse, const Elements& all, std::vector<Number>& numbers);
  template <typename Number>
  static void copy(const Elements& elements, Number* to);
  template <typename Number>
  static Number load_component(const Elements& elements, const char* from);
  static std::int64_t component_bytes(Type type);
  /// Returns the type of the owner's components, which must be one of indices.
  static Type index_type(const GltfObject& owner);

  std::filesystem::path path_;
  std::string bytes_;       // of a binary file
  std::string_view chunk_;  // its binary chunk
  std::int64_t file_bytes_ = 0;
  std::int64_t json_bytes_ = 0;
  bool binary_ = false;
  std::unique_ptr<nlohmann::json> json_;
  DecodedBuffers decoded_;
  std::optional<std::int64_t> bytes_of_buffers_;
};

}  // namespace semigeo::io
