// Compressed bytes: gzip, bzip2, xz, zstd, or none of them.
#include "io/files/byte_source.hpp"
#include "io/files/error.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {

void read_input(std::string_view bytes) {
  const std::filesystem::path path = write("file", bytes);
  // What is packed may be a thousand times as long, which takes its time.
  constexpr std::int64_t kMostBytes = 1 << 22;
  try {
    io::ByteSource source(path);
    while (source.position() < kMostBytes && source.fill(1)) {
      const std::string_view ahead = source.ahead();
      const auto at_once = static_cast<std::int64_t>(ahead.size() / 2 + 1);
      const std::int64_t before = source.position();
      check(source.skip(at_once) == at_once, "bytes that are ahead are not skipped");
      check(source.position() == before + at_once, "the position is wrong");
    }
    if (source.position() < kMostBytes) {
      check(source.drain() == 0, "there is more behind the end");
      check(source.xxh3().size() == 32, "a digest is no digest");
    }
  } catch (const io::Error& error) {
    check(error.file() == path, "an error names another file");
  }
}

}  // namespace semigeo::fuzz
