#pragma once

#include <zlib.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/input_file.hpp"

namespace semigeo::io {

/// Decompresses a gzip file while it is read: all its members, one after the other. Damaged or cut
/// data, a wrong checksum and bytes after the last member other than zero padding are `Error`s.
class GzipStream {
 public:
  static constexpr std::string_view kMagic = "\x1f\x8b";

  /// Begins to decompress. `start` holds the bytes of `file` that were read already.
  GzipStream(InputFile& file, std::string_view start);
  ~GzipStream();
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  /// Fills `bytes` as far as one or more steps of decompression reach. Returns the number of bytes,
  /// which is 0 only at the end.
  std::size_t read(std::span<char> bytes);

 private:
  bool refill();        // false at the end of the file
  bool start_member();  // false after the last one
  std::string place() const;

  InputFile& file_;
  std::vector<char> input_;
  z_stream stream_{};
  bool inside_member_ = false;
  bool first_member_ = true;
};

}  // namespace semigeo::io
