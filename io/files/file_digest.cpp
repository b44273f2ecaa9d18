#include "io/files/file_digest.hpp"

#include <xxhash.h>

#include <new>
#include <vector>

#include "io/files/container.hpp"
#include "io/files/hashed_stream.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

std::string hex(XXH128_hash_t hash) {
  XXH128_canonical_t digest;
  XXH128_canonicalFromHash(&digest, hash);
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest.digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

}  // namespace

HashedStream::HashedStream(ByteStream& stream) : stream_(stream), state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_128bits_reset(state_.get());
}

std::size_t HashedStream::read(std::span<char> bytes) {
  const std::size_t got = stream_.read(bytes);
  XXH3_128bits_update(state_.get(), bytes.data(), got);
  return got;
}

std::string HashedStream::finish() {
  std::vector<char> buffer(kBufferBytes);
  while (read(buffer) > 0) {
  }
  return hex(XXH3_128bits_digest(state_.get()));
}

std::string xxh3_of_stream(ByteStream& stream) {
  return HashedStream(stream).finish();
}

std::string xxh3_of_file(const std::filesystem::path& path) {
  return xxh3_of_stream(*open_bytes(path));
}

std::string xxh3_of_text(std::string_view text) {
  return hex(XXH3_128bits(text.data(), text.size()));
}

}  // namespace semigeo::io
