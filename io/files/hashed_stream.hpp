#pragma once

#include <xxhash.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "io/files/byte_stream.hpp"

namespace semigeo::io {

/// Hashes the bytes of a stream while they are read.
class HashedStream final : public ByteStream {
 public:
  /// Reads from `stream`, which must live as long as this.
  explicit HashedStream(ByteStream& stream);

  const std::filesystem::path& path() const override { return stream_.path(); }
  std::int64_t position() const override { return stream_.position(); }
  std::size_t read(std::span<char> bytes) override;

  /// Reads what is left. Returns the XXH3-128 of all bytes, as 32 hexadecimal digits.
  std::string finish();

 private:
  struct FreeState {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };

  ByteStream& stream_;
  std::unique_ptr<XXH3_state_t, FreeState> state_;
};

}  // namespace semigeo::io
