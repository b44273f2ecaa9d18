#include "io/scans/lzf.hpp"

#include <algorithm>
#include <cstdint>

namespace semigeo::io {
namespace {

/// Three packed bytes stand for at most so many.
constexpr std::size_t kLongestReference = 264;

}  // namespace

std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size) {
  std::string out;
  out.reserve(std::min(size, packed.size() / 3 * kLongestReference + packed.size()));
  std::size_t at = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(packed[at++]); };
  while (at < packed.size()) {
    const std::size_t control = next();
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - at || length > size - out.size()) return std::nullopt;
      out.append(packed.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (packed.size() - at < (length == 7 ? 2 : 1)) return std::nullopt;
    if (length == 7) length += next();
    length += 2;
    const std::size_t distance = ((control & 31) << 8) + next() + 1;
    if (distance > out.size() || length > size - out.size()) return std::nullopt;
    // The bytes may overlap: those that have just been written are read again.
    for (std::size_t from = out.size() - distance; length > 0; --length) out.push_back(out[from++]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace semigeo::io
