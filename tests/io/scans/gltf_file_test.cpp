#include "io/scans/gltf_file.hpp"

#include <gtest/gtest.h>

#include <string>

namespace semigeo::io {
namespace {

TEST(DecodedBuffersTest, KeepsThoseThatWereUsedLast) {
  constexpr std::size_t kBytes = DecodedBuffers::kMostBytes / 2;
  DecodedBuffers buffers;
  int decoded = 0;
  const auto get = [&](std::int64_t index) {
    return buffers.get(index, [&] {
      ++decoded;
      return std::string(kBytes, static_cast<char>('a' + index));
    });
  };
  const auto first = get(0);
  for (std::int64_t index = 1; index < 6; ++index) get(index);
  EXPECT_EQ(decoded, 6);
  EXPECT_LE(buffers.bytes(), DecodedBuffers::kMostBytes + kBytes);
  EXPECT_EQ(first->front(), 'a') << "what is in use stays";
  get(5);
  get(4);
  EXPECT_EQ(decoded, 6);
  EXPECT_EQ(get(0)->front(), 'a');
  EXPECT_EQ(decoded, 7);
}

}  // namespace
}  // namespace semigeo::io
