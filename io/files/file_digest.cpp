#include "io/files/file_digest.hpp"

#include <xxhash.h>

#include <memory>
#include <new>
#include <vector>

#include "io/files/container.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

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

std::string xxh3_of_stream(ByteStream& stream) {
  const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
  if (!state) throw std::bad_alloc();
  XXH3_128bits_reset(state.get());
  std::vector<char> buffer(kBufferBytes);
  while (const std::size_t got = stream.read(buffer))
    XXH3_128bits_update(state.get(), buffer.data(), got);

  return hex(XXH3_128bits_digest(state.get()));
}

std::string xxh3_of_file(const std::filesystem::path& path) {
  return xxh3_of_stream(*open_bytes(path));
}

std::string xxh3_of_text(std::string_view text) {
  return hex(XXH3_128bits(text.data(), text.size()));
}

}  // namespace semigeo::io
