#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "io/files/input_file.hpp"

namespace semigeo::io {

class GzipStream;

/// Reads a file's bytes from front to back through one fixed window. A gzip file (recognised by its
/// first bytes; several members in a row are one stream) is decompressed on the way. Memory does
/// not grow with the file. Damaged or cut gzip data is an `Error`. The class is not thread-safe.
class ByteSource {
 public:
  /// The largest number of bytes that can be looked at without consuming.
  static constexpr std::size_t kWindowBytes = std::size_t{1} << 20;

  explicit ByteSource(const std::filesystem::path& path);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  const std::filesystem::path& path() const { return file_.path(); }
  bool compressed() const { return gzip_ != nullptr; }
  /// Returns the number of bytes consumed so far, of the decompressed stream.
  std::int64_t position() const { return window_position_ + (cursor_ - window_.get()); }
  /// Returns "byte N", and for gzip also what the byte is one of.
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
  /// Returns the number of bytes not yet consumed, or nothing for a compressed file.
  std::optional<std::int64_t> bytes_left() const;
  /// Reads to the end, which for gzip verifies the checksum. Returns how many of the bytes were
  /// neither blanks, line ends nor zeros.
  std::int64_t drain();

 private:
  bool refill(std::size_t bytes);
  std::size_t read(char* to, std::size_t bytes);

  InputFile file_;
  std::unique_ptr<GzipStream> gzip_;
  std::unique_ptr<char[]> window_;
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
  std::int64_t window_position_ = 0;  // position of window_[0] in the stream
  bool ended_ = false;
};

}  // namespace semigeo::io
