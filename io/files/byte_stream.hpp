#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace semigeo::io {

/// Bytes that are read from front to back: a file, a member of a container, or what is compressed
/// in one of them. Failures of reading are `Error`s that name `path`.
class ByteStream {
 public:
  virtual ~ByteStream() = default;

  virtual const std::filesystem::path& path() const = 0;
  /// Returns the number of bytes read so far.
  virtual std::int64_t position() const = 0;
  /// Fills `bytes` as far as one or more steps of reading reach. Returns the number of bytes, which
  /// is 0 only at the end.
  virtual std::size_t read(std::span<char> bytes) = 0;
};

}  // namespace semigeo::io
