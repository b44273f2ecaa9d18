#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/files/byte_stream.hpp"
#include "io/files/hashed_stream.hpp"

namespace semigeo::io {

/// Reads the bytes of a file, or of a member of a container (container.hpp), from front to back
/// through one fixed window. What is compressed (compression.hpp), as its first bytes show, is
/// decompressed on the way. Memory does not grow with the file. Damaged or cut data is an `Error`.
/// The class is not thread-safe.
class ByteSource {
 public:
  /// The largest number of bytes that can be looked at without consuming.
  static constexpr std::size_t kWindowBytes = std::size_t{1} << 20;

  explicit ByteSource(const std::filesystem::path& path);
  /// Reads a stream, which must be at its start and live as long as this.
  explicit ByteSource(ByteStream& stream);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Returns "gzip" or another compression, or an empty text.
  std::string_view compression() const { return compression_; }
  /// Returns the number of bytes consumed so far, of the decompressed stream.
  std::int64_t position() const { return window_position_ + (cursor_ - window_.get()); }
  /// Returns "byte N", and for compressed bytes also what the byte is one of.
  std::string place(std::int64_t byte) const;

  /// Returns what has been read and not consumed. It is valid until the next call of another
  /// member.
  std::string_view ahead() const { return {cursor_, static_cast<std::size_t>(end_ - cursor_)}; }
  /// Reads until at least `bytes` (at most kWindowBytes) are ahead. Returns false if the stream
  /// ends first.
  bool fill(std::size_t bytes) {
    return static_cast<std::size_t>(end_ - cursor_) >= bytes || refill(bytes);
  }
  /// Moves past bytes that are ahead.
  void consume(std::size_t bytes) { cursor_ += bytes; }
  /// Moves past up to this number of bytes and returns how many there were.
  std::int64_t skip(std::int64_t bytes);
  /// Returns the number of bytes not yet consumed, or nothing for what is
  /// compressed or in a container: sizes that are told there are not trusted.
  std::optional<std::int64_t> bytes_left() const;
  /// Reads to the end, which for compressed bytes verifies the checksum. Returns how many of the
  /// bytes were neither blanks, line ends nor zeros.
  std::int64_t drain();
  /// Reads the bytes of the file to their end, of a compressed file the compressed ones. Returns
  /// their XXH3-128 (file_digest.hpp). Nothing can be read afterwards.
  std::string xxh3() { return raw_.finish(); }

 private:
  explicit ByteSource(std::unique_ptr<ByteStream> given);
  bool refill(std::size_t bytes);

  std::filesystem::path path_;
  std::string_view compression_;
  std::optional<std::int64_t> size_;  // of a plain file
  std::unique_ptr<ByteStream> file_;
  HashedStream raw_;
  std::unique_ptr<ByteStream> stream_;
  std::size_t window_bytes_ = kWindowBytes;  // less for a plain file that is smaller
  std::unique_ptr<char[]> window_;
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
  std::int64_t window_position_ = 0;  // position of window_[0] in the stream
  bool ended_ = false;
};

}  // namespace semigeo::io
