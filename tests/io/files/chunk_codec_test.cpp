#include "io/files/chunk_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string_view>

#include "io/hdf5/hdf5.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

constexpr std::uint32_t kUnfiltered = 3;  // shuffle and deflate skipped

std::vector<float> noisy_floats(std::size_t count) {
  std::mt19937 random(7);
  std::vector<float> values(count);
  for (float& value : values) value = 1 + static_cast<float>(random()) * 0x1p-33F;
  return values;
}

std::vector<std::int64_t> random_integers(std::size_t count) {
  std::mt19937_64 random(7);
  std::vector<std::int64_t> values(count);
  for (std::int64_t& value : values) value = static_cast<std::int64_t>(random());
  return values;
}

// What `array` decodes to, without padding.
std::vector<std::byte> decoded(const EncodedArray& array) {
  std::vector<std::byte> all;
  std::vector<std::byte> rows(static_cast<std::size_t>(array.shape.chunk_bytes()));
  for (std::size_t i = 0; i < array.chunks.size(); ++i) {
    const EncodedChunk& chunk = array.chunks[i];
    EXPECT_TRUE(decode_chunk(array.shape, chunk.bytes, chunk.filter_mask, rows));
    const auto used = static_cast<std::size_t>(
        array.shape.rows_in_chunk(static_cast<std::int64_t>(i)) * array.shape.row_bytes());
    EXPECT_EQ(chunk.raw_xxh3, xxh3_64(std::span(rows).first(used)));
    all.insert(all.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(used));
  }
  return all;
}

// What HDF5's own filters make of it.
std::vector<std::byte> through_library(const EncodedArray& array) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.write_array("/a", array);
  file.close();
  return Hdf5File::open(folder / "a.h5").read_through_library("/a");
}

template <typename Value>
void expect_stored(const EncodedArray& array, const std::vector<Value>& expected) {
  const auto bytes = std::as_bytes(std::span(expected));
  const std::vector<std::byte> wanted(bytes.begin(), bytes.end());
  EXPECT_EQ(decoded(array), wanted);
  EXPECT_EQ(through_library(array), wanted);
}

class ChunkCodec : public ::testing::TestWithParam<Compression> {};

TEST_P(ChunkCodec, NoisyFloatsComeBack) {
  const std::vector<float> values = noisy_floats(200001);
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

TEST_P(ChunkCodec, DoublesComeBack) {
  std::vector<double> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sqrt(static_cast<double>(i));
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

TEST_P(ChunkCodec, BytesComeBack) {
  std::vector<std::uint8_t> values(300000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint8_t>(i / 7);
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

TEST_P(ChunkCodec, RandomIntegersComeBack) {
  const std::vector<std::int64_t> values = random_integers(70000);
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

TEST_P(ChunkCodec, ZerosComeBack) {
  const std::vector<std::int32_t> values(70000, 0);
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

// Numbers of vertices: noise in the low bytes, runs in the middle, zeros in the high bytes. Lengths
// of planes pass a match of 258 bytes by zero, one and 257.
TEST_P(ChunkCodec, NumbersOfVerticesComeBack) {
  for (const std::size_t count : {1032U, 1033U, 1289U, 32768U, 70001U}) {
    std::mt19937 random(7);
    std::vector<std::int64_t> values(count);
    for (std::size_t i = 0; i < count; ++i)
      values[i] = static_cast<std::int64_t>(random() & 0xffff) | (i / 300 % 5) << 16;
    expect_stored(encode_array(array_of(values), GetParam()), values);
    for (std::int64_t& value : values) value &= 0xffff;  // nothing between noise and zeros
    expect_stored(encode_array(array_of(values), GetParam()), values);
    for (std::int64_t& value : values) value &= 0xff00;  // zeros in front, too
    expect_stored(encode_array(array_of(values), GetParam()), values);
  }
}

// The compressor makes several blocks of 96 KiB, of which the last one has to be found, and ends
// them at any bit.
TEST_P(ChunkCodec, NumbersWithSkewedBytesComeBack) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::int64_t> values(32768);
    for (std::int64_t& value : values)
      value = static_cast<std::int64_t>(random() & random() & random() & 0xffffff);
    expect_stored(encode_array(array_of(values), GetParam()), values);
  }
}

// All bytes of such planes are the same; some have codes of eight bits, others of nine.
TEST_P(ChunkCodec, ConstantsComeBack) {
  for (const std::size_t count : {1032U, 1033U, 1290U, 70001U})
    for (const float value : {1.0F, -1.0F, -3.14159F, std::numeric_limits<float>::max()})
      expect_stored(encode_array(array_of(std::vector<float>(count, value)), GetParam()),
                    std::vector<float>(count, value));
}

TEST_P(ChunkCodec, OneRowComesBack) {
  const std::vector<float> values = {42};
  expect_stored(encode_array(array_of(values), GetParam()), values);
}

TEST_P(ChunkCodec, TrianglesAreWidened) {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int64_t> expected;
  for (std::int32_t i = 0; i < 30000; ++i) {
    triangles.push_back({i, -i, i + 5});
    expected.insert(expected.end(), {i, -i, i + 5});
  }
  const EncodedArray array =
      encode_array(array_of(std::span(std::as_const(triangles))), GetParam());
  EXPECT_EQ(array.shape.type, ElementType::kInt64);
  EXPECT_EQ(array.shape.columns, 3);
  expect_stored(array, expected);
}

TEST_P(ChunkCodec, PointsAreNarrowedAndReordered) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 30000; ++i) points.emplace_back(i, 0.1 * i, -i);
  std::vector<std::int32_t> order(points.size());
  std::iota(order.rbegin(), order.rend(), 0);
  order.resize(29000);  // an order may also select
  std::vector<float> expected;
  for (const std::int32_t i : order)
    for (int c = 0; c < 3; ++c) expected.push_back(static_cast<float>(points[i][c]));
  expect_stored(encode_array(array_of(std::span(std::as_const(points)), order), GetParam()),
                expected);
}

TEST_P(ChunkCodec, EmptyArrayHasNoChunks) {
  const EncodedArray array = encode_array(array_of(std::vector<float>{}), GetParam());
  EXPECT_TRUE(array.chunks.empty());
  EXPECT_EQ(array.shape.rows, 0);
}

TEST_P(ChunkCodec, NoticesEveryChangedByte) {
  const std::vector<float> values = noisy_floats(1500);
  const EncodedArray array = encode_array(array_of(values), GetParam());
  std::vector<std::byte> bytes = array.chunks[0].bytes;
  std::vector<std::byte> rows(static_cast<std::size_t>(array.shape.chunk_bytes()));
  for (std::byte& byte : bytes) {
    byte ^= std::byte{0x10};
    EXPECT_FALSE(decode_chunk(array.shape, bytes, array.chunks[0].filter_mask, rows));
    byte ^= std::byte{0x10};
  }
  EXPECT_TRUE(decode_chunk(array.shape, bytes, array.chunks[0].filter_mask, rows));
}

TEST_P(ChunkCodec, RefusesTruncatedChunks) {
  const std::vector<float> values = noisy_floats(1200);
  const EncodedArray array = encode_array(array_of(values), GetParam());
  const std::span<const std::byte> bytes(array.chunks[0].bytes);
  std::vector<std::byte> rows(static_cast<std::size_t>(array.shape.chunk_bytes()));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_FALSE(decode_chunk(array.shape, bytes.first(length), 0, rows)) << length;
}

std::string compression_name(const ::testing::TestParamInfo<Compression>& compression) {
  return compression.param == Compression::kNone ? "none" : "deflate";
}

INSTANTIATE_TEST_SUITE_P(All, ChunkCodec,
                         ::testing::Values(Compression::kNone, Compression::kDeflate),
                         compression_name);

TEST(ChunkCodecDeflate, StoresNoiseButPacksTheRest) {
  // Two of four bytes are noise: the chunk must shrink, though not by more than the other half.
  const EncodedArray array = encode_array(array_of(noisy_floats(65536)), Compression::kDeflate);
  ASSERT_EQ(array.chunks.size(), 1U);
  EXPECT_EQ(array.chunks[0].filter_mask, 0U);
  EXPECT_LT(array.chunks[0].bytes.size(), 230000U);
  EXPECT_GT(array.chunks[0].bytes.size(), 131072U);
}

TEST(ChunkCodecDeflate, SkipsFiltersThatDoNotShrink) {
  const EncodedArray array = encode_array(array_of(random_integers(32768)), Compression::kDeflate);
  ASSERT_EQ(array.chunks.size(), 1U);
  EXPECT_EQ(array.chunks[0].filter_mask, kUnfiltered);
  EXPECT_EQ(array.chunks[0].bytes.size(), 262144U + 4U);
}

TEST(ChunkCodecDeflate, PaddingRepeatsTheLastRowAndIsNotHashed) {
  std::vector<float> values(70001, 1.0F);  // 65536 rows are a full chunk: two of 35001 rows
  values.back() = 2.0F;
  const EncodedArray array = encode_array(array_of(values), Compression::kDeflate);
  ASSERT_EQ(array.chunks.size(), 2U);
  std::vector<float> rows(35001);
  ASSERT_TRUE(
      decode_chunk(array.shape, array.chunks[1].bytes, 0, std::as_writable_bytes(std::span(rows))));
  EXPECT_EQ(rows[34998], 1.0F);
  EXPECT_EQ(rows[34999], 2.0F);
  EXPECT_EQ(rows[35000], 2.0F);
  EXPECT_EQ(array.chunks[1].raw_xxh3, xxh3_64(std::as_bytes(std::span(rows).first(35000))));
}

TEST(ChunkCodecDeflate, PacksConstantsIntoAHundredthPart) {
  const EncodedArray array =
      encode_array(array_of(std::vector<float>(65536, -1.0F)), Compression::kDeflate);
  ASSERT_EQ(array.chunks.size(), 1U);
  EXPECT_LT(array.chunks[0].bytes.size(), 2622U);
}

TEST(ChunkCodecShape, SmallArraysAreCompact) {
  for (const Compression compression : {Compression::kNone, Compression::kDeflate}) {
    const EncodedArray small = encode_array(array_of(noisy_floats(1024)), compression);
    EXPECT_TRUE(small.shape.compact);
    EXPECT_EQ(small.shape.chunk_count(), 1);
    expect_stored(small, noisy_floats(1024));
    std::vector<std::byte> rows(4096);
    EXPECT_FALSE(decode_chunk(small.shape, std::span(small.chunks[0].bytes).first(4095), 0, rows));
    const EncodedArray large = encode_array(array_of(noisy_floats(1025)), compression);
    EXPECT_FALSE(large.shape.compact);
    expect_stored(large, noisy_floats(1025));
  }
}

TEST(ChunkCodecShape, ChunksHaveAtMostAQuarterMebibyteAndEqualShares) {
  ArrayView view = array_of(std::span<const Eigen::Vector3f>());
  view.rows = 1'500'000;  // 21845 rows are 256 KiB, of which 69 chunks are needed
  const ArrayShape shape = shape_of(view, Compression::kDeflate);
  EXPECT_EQ(shape.chunk_count(), 69);
  EXPECT_EQ(shape.chunk_rows, 21740);
  EXPECT_EQ(shape.rows_in_chunk(68), 1'500'000 - 68 * 21740);
}

TEST(ChunkCodecShape, RefusesConversionsThatLoseAndChunksThatAreNot) {
  const std::vector<std::int64_t> values(10);
  ArrayView view = array_of(values);
  EXPECT_THROW(encode_chunk(view, 1, Compression::kNone), std::invalid_argument);
  EXPECT_THROW(encode_chunk(view, -1, Compression::kNone), std::invalid_argument);
  EXPECT_THROW(encode_rows(shape_of(view, Compression::kNone), {}), std::invalid_argument);
  view.stored_type = ElementType::kInt32;
  EXPECT_THROW(encode_chunk(view, 0, Compression::kNone), std::invalid_argument);
}

TEST(Fletcher32, KnownSums) {
  // Big-endian words: 0x6162 + 0x6364 = 0xc4c6; 0x6162 + 0xc4c6 = 0x12628 -> 0x2629.
  const auto sum = [](std::string_view text) { return fletcher32(std::as_bytes(std::span(text))); };
  EXPECT_EQ(sum("abcd"), 0x2629c4c6U);
  EXPECT_EQ(sum(""), 0U);
  EXPECT_EQ(sum(std::string_view("\0\0\0", 3)), 0U);
  EXPECT_EQ(sum("\xff\xff"), 0xffffffffU);  // 65535 and not 0: the other zero
  EXPECT_EQ(sum("a"), 0x61006100U);
}

}  // namespace
}  // namespace semigeo::io
