#pragma once

#include <zlib.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// Decompresses gzip data while it is read: all its members, one after the other. Damaged or cut
/// data, a wrong checksum and bytes after the last member other than zero padding are `Error`s.
class GzipStream final : public ByteStream {
 public:
  static constexpr std::string_view kMagic = "\x1f\x8b";

  /// Begins to decompress. `start` holds the bytes of `packed` that were read already.
  GzipStream(std::unique_ptr<ByteStream> packed, std::string_view start);
  ~GzipStream() override;
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  const std::filesystem::path& path() const override { return packed_->path(); }
  std::int64_t position() const override { return position_; }
  std::size_t read(std::span<char> bytes) override;

 private:
  bool refill();        // false at the end of the data
  bool start_member();  // false after the last one
  bool step();          // false at the end
  std::string place() const;

  std::unique_ptr<ByteStream> packed_;
  std::vector<char> input_;
  z_stream stream_{};
  std::int64_t position_ = 0;
  std::exception_ptr damage_;
  bool inside_member_ = false;
  bool first_member_ = true;
};

}  // namespace semigeo::io
