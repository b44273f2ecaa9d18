#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/descriptor.hpp"
#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// A regular file opened for reading, from front to back or anywhere. A missing file, a folder, a
/// pipe, a missing permission and a read error are `Error`s that say which of them it was.
class InputFile final : public ByteStream {
 public:
  explicit InputFile(std::filesystem::path path);

  const std::filesystem::path& path() const override { return path_; }
  /// Returns the number of bytes in the file when it was opened.
  std::int64_t size() const { return size_; }
  /// Returns the number of bytes read so far.
  std::int64_t position() const override { return position_; }
  /// Fills `bytes` and returns how many there were: fewer than asked only at the end of the file.
  std::size_t read(std::span<char> bytes) override;
  /// Fills `bytes` from any place on, without moving. May be called by several threads at once.
  std::size_t read_at(std::uint64_t offset, std::span<char> bytes) const;

 private:
  [[noreturn]] void fail(std::uint64_t offset) const;

  std::filesystem::path path_;
  engine::Descriptor descriptor_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
};

}  // namespace semigeo::io
