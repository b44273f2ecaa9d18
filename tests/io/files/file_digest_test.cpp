#include "io/files/file_digest.hpp"

#include <xxhash.h>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

TEST(FileDigest, IsThePublishedHashOfNothing) {
  const tests::TemporaryFolder folder;
  EXPECT_EQ(xxh3_of_file(write_file(folder / "empty", "")), "99aa06d3014798d86001c324468d497f");
}

TEST(FileDigest, StreamsToTheSameHash) {
  const tests::TemporaryFolder folder;
  std::string bytes;
  for (unsigned i = 0; i < 1'000'000; ++i) bytes += static_cast<char>(i * i >> 4);
  XXH128_canonical_t expected;
  XXH128_canonicalFromHash(&expected, XXH3_128bits(bytes.data(), bytes.size()));
  std::string digits;
  for (const unsigned char byte : expected.digest) {
    char text[3];
    std::snprintf(text, sizeof text, "%02x", byte);
    digits += text;
  }
  EXPECT_EQ(xxh3_of_file(write_file(folder / "large", bytes)), digits);
  bytes[999'999] = static_cast<char>(bytes[999'999] ^ 1);
  EXPECT_NE(xxh3_of_file(write_file(folder / "large", bytes)), digits);
}

TEST(FileDigest, TakesCompressedFilesAsTheyAre) {
  const tests::TemporaryFolder folder;
  EXPECT_NE(xxh3_of_file(write_file(folder / "a", "text")),
            xxh3_of_file(write_file(folder / "a.gz", gzip("text"))));
}

TEST(FileDigest, RefusesWhatIsNoFile) {
  const tests::TemporaryFolder folder;
  EXPECT_THROW(xxh3_of_file(folder / "missing"), Error);
  EXPECT_THROW(xxh3_of_file(folder.path()), Error);
}

}  // namespace
}  // namespace semigeo::io
