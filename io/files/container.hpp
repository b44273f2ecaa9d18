#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

class Libarchive;

/// Returns whether a file's name is that of a container of files: .zip, .7z, .tar, .tgz, .tar.gz,
/// and the same for the other compressions. The case does not matter. The file is not looked at.
bool is_container_name(const std::filesystem::path& path);

/// Returns all extensions of containers: ".zip", ".tar.gz".
std::vector<std::string> container_extensions();

/// A place in a container: "box.zip/part/a.ply" is "part/a.ply" in box.zip.
struct MemberPath {
  std::filesystem::path container;
  std::string member;
};

/// Returns the container and the member that a path leads to. Returns nothing if no folder of the
/// path is a file with the name of a container.
std::optional<MemberPath> member_path(const std::filesystem::path& path);

/// Returns the file that a path leads to: the container for a member, also if it is gone, and the
/// path itself for others.
std::filesystem::path outer_file(const std::filesystem::path& path);

/// Reads the members of a container one after the other, in one pass. As a stream it is the current
/// member. Damage is an `Error`; members before it can be read.
///
/// Names of members are made safe: separators at the beginning, "." and ".." are left out. They are
/// never names of files on the disk.
class ContainerReader final : public ByteStream {
 public:
  /// The largest number of members; a container with more is an `Error`.
  static constexpr std::int64_t kMostMembers = 1'000'000;

  enum class Kind { kFile, kFolder, kLink, kOther };

  /// Opens a container. Throws Error if it cannot be read or is none.
  explicit ContainerReader(const std::filesystem::path& container);
  ~ContainerReader() override;
  ContainerReader(const ContainerReader&) = delete;
  ContainerReader& operator=(const ContainerReader&) = delete;

  /// Moves to the next member. Returns false at the end.
  bool next();
  /// Returns the name of the current member.
  const std::string& name() const { return name_; }
  Kind kind() const { return kind_; }
  bool is_encrypted() const { return encrypted_; }
  /// Returns the size of the current member as the container tells it, which may be wrong.
  std::optional<std::int64_t> size() const { return size_; }

  /// Returns the path of the current member.
  const std::filesystem::path& path() const override { return path_; }
  std::int64_t position() const override { return position_; }
  /// Reads the current member, which must be a file. Throws Error if it is encrypted or damaged.
  std::size_t read(std::span<char> bytes) override;

 private:
  [[noreturn]] void fail_listing();
  [[noreturn]] void fail_member();

  std::filesystem::path container_;
  std::int64_t container_bytes_ = 0;
  std::unique_ptr<Libarchive> archive_;
  std::filesystem::path path_;
  std::string name_;
  Kind kind_ = Kind::kOther;
  bool encrypted_ = false;
  std::optional<std::int64_t> size_;
  std::int64_t position_ = 0;
  std::int64_t members_ = 0;
};

/// A file in a container.
struct Member {
  std::string name;
  std::int64_t bytes = 0;  ///< As the container tells it; 0 if it does not.
  bool encrypted = false;
};

/// What is in a container.
struct ContainerListing {
  std::vector<Member> members;  ///< Files, each with a name of its own, in the container's order.
  std::int64_t links = 0;       ///< Number of symbolic and hard links.
  std::int64_t repeated = 0;    ///< Number of files with the name of a file before them.
  std::string error;            ///< Why it or the rest of it cannot be listed; empty if all could.
};

/// Lists a container. Reads its directory, or passes once over it if it has none.
ContainerListing list_container(const std::filesystem::path& container);

/// Opens the file or the member of a container that a path leads to. Throws Error if there is none.
std::unique_ptr<ByteStream> open_bytes(const std::filesystem::path& path);

}  // namespace semigeo::io
