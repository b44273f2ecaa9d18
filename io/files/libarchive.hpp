#pragma once

#include <archive.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "io/files/byte_stream.hpp"
#include "io/files/input_file.hpp"

namespace semigeo::io {

/// A reader of libarchive and the bytes that it reads. Formats and filters must be enabled on `get`
/// before `open`. Errors of the bytes pass through libarchive as exceptions.
class Libarchive {
 public:
  /// Reads the stream from front to back.
  explicit Libarchive(std::unique_ptr<ByteStream> stream);
  /// Reads the file anywhere.
  explicit Libarchive(std::unique_ptr<InputFile> file);
  ~Libarchive();
  Libarchive(const Libarchive&) = delete;
  Libarchive& operator=(const Libarchive&) = delete;

  archive* get() const { return archive_; }
  /// Returns ARCHIVE_OK or the code of an error.
  int open();
  /// Returns the code of a call of libarchive. Throws what the bytes have thrown during the call.
  template <typename Call>
  auto call(const Call& call_it) {
    const auto code = call_it();
    if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
    return code;
  }
  /// Returns what libarchive says of the last failure.
  std::string message() const;
  /// Returns the number of bytes that libarchive has got.
  std::int64_t fed() const { return offset_; }
  /// Reads the bytes to the end. Returns whether any that libarchive has not used is not zero.
  bool has_other_bytes();

 private:
  static la_ssize_t read(archive* reader, void* self, const void** bytes);
  static la_int64_t skip(archive* reader, void* self, la_int64_t bytes);
  static la_int64_t seek(archive* reader, void* self, la_int64_t offset, int whence);

  std::unique_ptr<ByteStream> stream_;  // null if file_ is not
  std::unique_ptr<InputFile> file_;
  std::vector<char> buffer_;
  std::size_t got_ = 0;  // bytes of the buffer that hold something
  std::int64_t offset_ = 0;
  std::exception_ptr problem_;
  archive* archive_;
};

}  // namespace semigeo::io
