#include "io/scans/whole_source.hpp"

#include <algorithm>

#include "io/files/error.hpp"

namespace semigeo::io {

std::string read_whole(ByteSource& source, std::int64_t most) {
  std::string bytes;
  while (std::ssize(bytes) < most && source.fill(1)) {
    const std::string_view ahead = source.ahead();
    const auto step = std::min(static_cast<std::size_t>(most) - bytes.size(), ahead.size());
    bytes += ahead.substr(0, step);
    source.consume(step);
    if (std::ssize(bytes) > kMaxWholeBytes)
      throw Error(source.path(), "", "the file is larger than 4 GiB",
                  "cut the scan into parts or export it as .ply");
  }
  return bytes;
}

}  // namespace semigeo::io
