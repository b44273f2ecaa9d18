#include "io/files/chunk_codec.hpp"

#include <libdeflate.h>
#include <xxhash.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace semigeo::io {
namespace {

static_assert(std::endian::native == std::endian::little,
              "stored arrays are little endian and chunks are written as they lie in memory");

constexpr std::int64_t kMostChunkBytes = 256 * 1024;
constexpr int kFastest = 1;
constexpr std::size_t kChecksumBytes = 4;

// The filters of Compression::kDeflate as bits of the filter mask.
constexpr std::uint32_t kSkipShuffle = 1U << 0;
constexpr std::uint32_t kSkipDeflate = 1U << 1;

struct FreeCompressor {
  void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
};
struct FreeDecompressor {
  void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
};

constexpr std::int64_t divided_up(std::int64_t a, std::int64_t b) {
  return (a + b - 1) / b;
}

template <typename Memory, typename Stored>
void convert_rows(const ArrayView& view, std::int64_t first, std::int64_t count, std::byte* out) {
  for (std::int64_t i = first; i < first + count; ++i) {
    const std::int64_t row = view.row_order.empty() ? i : view.row_order[i];
    const std::byte* in = view.data + row * view.row_stride;
    for (int c = 0; c < view.columns; ++c) {
      Memory value;
      std::memcpy(&value, in + c * sizeof(Memory), sizeof(Memory));
      const auto stored = static_cast<Stored>(value);
      std::memcpy(out, &stored, sizeof(Stored));
      out += sizeof(Stored);
    }
  }
}

void gather_records(const ArrayView& view, std::int64_t first, std::int64_t count, std::byte* out) {
  const auto size = static_cast<std::size_t>(size_of(view.memory_type));
  for (std::int64_t i = first; i < first + count; ++i, out += size) {
    const std::int64_t row = view.row_order.empty() ? i : view.row_order[i];
    std::memcpy(out, view.data + row * view.row_stride, size);
  }
}

void gather_rows(const ArrayView& view, std::int64_t first, std::int64_t count, std::byte* out) {
  using enum ElementType;
  if (view.memory_type == view.stored_type) {
    const std::int64_t row_bytes = view.columns * size_of(view.memory_type);
    if (view.row_order.empty() && view.row_stride == row_bytes) {
      std::memcpy(out, view.data + first * row_bytes, static_cast<std::size_t>(count * row_bytes));
    } else if (!members_of(view.memory_type).empty()) {
      gather_records(view, first, count, out);
    } else if (size_of(view.memory_type) == 4) {
      convert_rows<std::uint32_t, std::uint32_t>(view, first, count, out);
    } else if (size_of(view.memory_type) == 8) {
      convert_rows<std::uint64_t, std::uint64_t>(view, first, count, out);
    } else if (size_of(view.memory_type) == 2) {
      convert_rows<std::uint16_t, std::uint16_t>(view, first, count, out);
    } else {
      convert_rows<std::uint8_t, std::uint8_t>(view, first, count, out);
    }
  } else if (view.memory_type == kInt32 && view.stored_type == kInt64) {
    convert_rows<std::int32_t, std::int64_t>(view, first, count, out);
  } else if (view.memory_type == kFloat64 && view.stored_type == kFloat32) {
    convert_rows<double, float>(view, first, count, out);
  } else {
    throw std::invalid_argument("no conversion from " + std::string(name_of(view.memory_type)) +
                                " to " + std::string(name_of(view.stored_type)));
  }
}

// Calls `action` with the size of an element. Common sizes are constants, which makes loops fast.
template <typename Action>
void with_known_size(std::size_t size, const Action& action) {
  switch (size) {
    case 1:
      return action(std::integral_constant<std::size_t, 1>());
    case 4:
      return action(std::integral_constant<std::size_t, 4>());
    case 8:
      return action(std::integral_constant<std::size_t, 8>());
    default:
      return action(size);
  }
}

void shuffle(std::span<const std::byte> in, std::size_t element_size, std::byte* out) {
  const auto planes = [&](auto size) {
    const std::size_t elements = in.size() / size;
    for (std::size_t i = 0; i < elements; ++i)
      for (std::size_t b = 0; b < size; ++b) out[b * elements + i] = in[i * size + b];
  };
  with_known_size(element_size, planes);
}

void unshuffle(std::span<const std::byte> in, std::size_t element_size, std::byte* out) {
  const auto rows = [&](auto size) {
    const std::size_t elements = in.size() / size;
    for (std::size_t i = 0; i < elements; ++i)
      for (std::size_t b = 0; b < size; ++b) out[i * size + b] = in[b * elements + i];
  };
  with_known_size(element_size, rows);
}

// Appends what HDF5's fletcher32 filter appends: the checksum, least significant byte first.
std::vector<std::byte> with_checksum(std::span<const std::byte> bytes) {
  std::vector<std::byte> result(bytes.size() + kChecksumBytes);
  std::memcpy(result.data(), bytes.data(), bytes.size());
  const std::uint32_t sum = fletcher32(bytes);
  std::memcpy(result.data() + bytes.size(), &sum, kChecksumBytes);
  return result;
}

// Pads rows to `size` bytes. Copies of the last row compress better than zeros, which would end
// planes of one byte.
std::vector<std::byte> with_last_row_repeated(std::span<const std::byte> rows,
                                              std::size_t row_bytes, std::size_t size) {
  std::vector<std::byte> padded(rows.begin(), rows.end());
  padded.reserve(size);
  while (padded.size() < size)
    padded.insert(padded.end(), rows.end() - static_cast<std::ptrdiff_t>(row_bytes), rows.end());
  return padded;
}

using Compressor = std::unique_ptr<libdeflate_compressor, FreeCompressor>;

// Returns how many planes at the front of shuffled rows are noise. The low bytes of coordinates,
// and of the vertices of triangles, are noise, and shuffling puts them in front, one plane after
// the other. A sample is packed to find out. It must become shorter by a thirty-second part.
std::size_t noise_in_front(libdeflate_compressor* compressor, std::span<const std::byte> shuffled,
                           std::size_t element_size) {
  constexpr std::size_t kSample = 4096;
  const std::size_t plane = shuffled.size() / element_size;
  if (plane < 2 * kSample) return 0;
  std::array<std::byte, kSample> packed;
  std::size_t noise = 0;
  while (noise + 1 < element_size &&
         libdeflate_deflate_compress(compressor,
                                     shuffled.data() + noise * plane + (plane - kSample) / 2,
                                     kSample, packed.data(), kSample - kSample / 32) == 0)
    ++noise;
  return noise;
}

// Writes stored blocks of a deflate stream (RFC 1951, 3.2.4). None of them is the last block.
std::byte* put_stored_blocks(std::span<const std::byte> bytes, std::byte* out) {
  while (!bytes.empty()) {
    const auto length = static_cast<std::uint16_t>(std::min<std::size_t>(bytes.size(), 0xffff));
    const auto complement = static_cast<std::uint16_t>(~length);
    *out++ = std::byte{0};
    std::memcpy(out, &length, 2);
    std::memcpy(out + 2, &complement, 2);
    std::memcpy(out + 4, bytes.data(), length);
    out += 4 + length;
    bytes = bytes.subspan(length);
  }
  return out;
}

// Returns how many planes at the back of shuffled rows repeat one byte: the high bytes of numbers
// of vertices are zeros, and where all patches are complete, all bytes of completeness are the
// same. Returns 0 if they are so few that the compressor may have them too.
std::size_t constant_planes_at_back(std::span<const std::byte> shuffled, std::size_t element_size) {
  const std::size_t plane = shuffled.size() / element_size;
  std::size_t planes = 0;
  if (plane == 0) return planes;
  while (planes < element_size) {
    const std::byte* bytes = shuffled.data() + (element_size - planes - 1) * plane;
    if (std::memcmp(bytes, bytes + 1, plane - 1) != 0) break;
    ++planes;
  }
  constexpr std::size_t kFew = 5;  // one in so many
  return kFew * planes < element_size ? 0 : planes;
}

// Tells from which bit to which one a block of a deflate stream lies.
struct BlockBits {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// Finds the last block of a deflate stream, whose content goes to `inflated`. zlib.h describes at
// inflate() how it stops at the ends of blocks.
BlockBits last_block(std::span<const std::byte> stream, std::span<std::byte> inflated) {
  constexpr int kRaw = -15;
  constexpr int kUnusedBits = 7;
  constexpr int kLastBlock = 64;
  z_stream state = {};
  if (inflateInit2(&state, kRaw) != Z_OK) throw std::bad_alloc();
  state.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(stream.data()));
  state.avail_in = static_cast<uInt>(stream.size());
  state.next_out = reinterpret_cast<Bytef*>(inflated.data());
  state.avail_out = static_cast<uInt>(inflated.size());
  BlockBits block;
  int status = Z_OK;
  do {
    block.begin = block.end;
    status = inflate(&state, Z_BLOCK);
    block.end = 8 * state.total_in - static_cast<std::size_t>(state.data_type & kUnusedBits);
  } while (status == Z_OK && (state.data_type & kLastBlock) == 0);
  inflateEnd(&state);
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK) throw std::logic_error("a stream of libdeflate has no last block");
  return block;
}

constexpr std::size_t kLongestMatch = 258;

// Bounds the length of put_constant_planes: thirteen bits for a match, and nine for each byte that
// is less than a match.
constexpr std::size_t most_of_constant_planes(std::size_t planes, std::size_t plane) {
  return planes * (plane / kLongestMatch * 13 / 8 + (kLongestMatch + 1) * 9 / 8 + 2) + 3;
}

// Writes the last block of a deflate stream, which holds planes of `plane` bytes that are all the
// same, with the fixed codes of RFC 1951, 3.2.6: literals, and matches of the byte before. The
// lowest `held` bits at `out` stay.
std::byte* put_constant_planes(std::span<const std::byte> planes, std::size_t plane, int held,
                               std::byte* out) {
  std::uint64_t bits = held > 0 ? std::to_integer<std::uint64_t>(*out) & ((1U << held) - 1) : 0;
  const auto put = [&](std::uint64_t code, int length) {
    bits |= code << held;
    for (held += length; held >= 8; held -= 8, bits >>= 8) *out++ = static_cast<std::byte>(bits);
  };
  // Codes are sent from their most significant bit, which is the lowest bit of these constants.
  const auto put_reversed = [&](unsigned code, int length) {
    std::uint64_t reversed = 0;
    for (int bit = 0; bit < length; ++bit)
      reversed |= std::uint64_t{code >> bit & 1} << (length - 1 - bit);
    put(reversed, length);
  };
  const auto put_literal = [&](unsigned byte) {
    byte < 144 ? put_reversed(0b00110000 + byte, 8) : put_reversed(0b110010000 + byte - 144, 9);
  };
  const auto put_match = [&] { put(0b00000'10100011, 13); };  // 285: 258 bytes; distance 1
  put(0b011, 3);                                              // last block, fixed codes
  for (; !planes.empty(); planes = planes.subspan(plane)) {
    const auto byte = std::to_integer<unsigned>(planes.front());
    put_literal(byte);
    std::size_t count = plane - 1;
    for (; count >= kLongestMatch; count -= kLongestMatch) put_match();
    for (; count > 0; --count) put_literal(byte);
  }
  put(0, 7);  // end of block
  put(0, 7);  // fills the last byte
  return out;
}

// Writes `bytes` as a zlib stream (RFC 1950) to `out`, which must have room for as many bytes as
// the input. They are planes of `plane` bytes. The first `noise` planes are stored as they are,
// because the compressor would spend most of its time on them in vain; each of the last `constant`
// planes repeats one byte. Returns the length of the stream, or 0 if it is not shorter than the
// input.
std::size_t zlib_stream(libdeflate_compressor* compressor, std::span<const std::byte> bytes,
                        std::size_t plane, std::size_t noise, std::size_t constant,
                        std::byte* out) {
  constexpr std::size_t kHeader = 2;
  constexpr std::size_t kTrailer = 4;
  const auto stored = bytes.first(noise * plane);
  const auto repeated = bytes.last(constant * plane);
  const auto middle = bytes.subspan(stored.size(), bytes.size() - stored.size() - repeated.size());
  const std::size_t blocks = (stored.size() + 0xfffe) / 0xffff;
  const std::size_t before = kHeader + stored.size() + 5 * blocks;
  const std::size_t behind =
      kTrailer + (repeated.empty() ? 0 : most_of_constant_planes(constant, plane));
  if (before + behind >= bytes.size()) return 0;
  const std::size_t room = bytes.size() - 1 - before - behind;
  out[0] = std::byte{0x78};  // deflate, window of 32 KiB
  out[1] = std::byte{0x01};  // fastest level, no dictionary, check bits
  std::byte* end = put_stored_blocks(stored, out + kHeader);
  int held = 0;
  if (repeated.empty() || !middle.empty()) {
    const std::size_t length =
        libdeflate_deflate_compress(compressor, middle.data(), middle.size(), end, room);
    if (length == 0) return 0;
    if (repeated.empty()) {
      end += length;
    } else {
      // libdeflate only makes whole streams. Its last block must say that another one follows.
      const auto inflated = std::make_unique_for_overwrite<std::byte[]>(middle.size());
      const BlockBits last = last_block({end, length}, {inflated.get(), middle.size()});
      end[last.begin / 8] &= ~(std::byte{1} << (last.begin % 8));
      end += last.end / 8;
      held = static_cast<int>(last.end % 8);
    }
  }
  if (!repeated.empty()) end = put_constant_planes(repeated, plane, held, end);
  const std::uint32_t adler = libdeflate_adler32(1, bytes.data(), bytes.size());
  for (int shift = 24; shift >= 0; shift -= 8)
    *end++ = static_cast<std::byte>(adler >> shift & 0xff);
  return static_cast<std::size_t>(end - out);
}

bool inflate(std::span<const std::byte> bytes, std::span<std::byte> out) {
  const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
      libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  std::size_t written = 0;
  return libdeflate_zlib_decompress(decompressor.get(), bytes.data(), bytes.size(), out.data(),
                                    out.size(), &written) == LIBDEFLATE_SUCCESS &&
         written == out.size();
}

}  // namespace

std::uint64_t xxh3_64(std::span<const std::byte> bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  // Big-endian 16-bit words are summed modulo 65535. Sums are reduced seldom, which is cheap, but
  // before 64 bits overflow. A reduced sum is 0 only if every byte is 0; HDF5 chooses so between
  // the two representations of zero.
  constexpr std::size_t kBlock = 1 << 16;
  const auto fold = [](std::uint64_t x) { return (x & 0xffff) + (x >> 16); };
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  std::uint64_t sum1 = 0;
  std::uint64_t sum2 = 0;
  for (std::size_t words = bytes.size() / 2; words > 0;) {
    const std::size_t block = std::min(words, kBlock);
    for (std::size_t i = 0; i < block; ++i, data += 2) {
      sum1 += static_cast<std::uint64_t>(data[0]) << 8 | data[1];
      sum2 += sum1;
    }
    sum1 = fold(fold(fold(sum1)));
    sum2 = fold(fold(fold(fold(sum2))));
    words -= block;
  }
  if (bytes.size() % 2 == 1) {
    sum1 += static_cast<std::uint64_t>(data[0]) << 8;
    sum2 += sum1;
  }
  sum1 = fold(fold(sum1));
  sum2 = fold(fold(sum2));
  return static_cast<std::uint32_t>(sum2 << 16 | sum1);
}

ArrayShape shape_of(const ArrayView& view, Compression compression) {
  ArrayShape shape{view.stored_type, view.rows, view.columns, 1, compression};
  const std::int64_t most_rows = std::max<std::int64_t>(1, kMostChunkBytes / shape.row_bytes());
  const std::int64_t chunks = std::max<std::int64_t>(1, divided_up(view.rows, most_rows));
  shape.chunk_rows = std::max<std::int64_t>(1, divided_up(view.rows, chunks));
  shape.compact = view.rows > 0 && view.rows * shape.row_bytes() <= kMostCompactBytes;
  if (shape.compact) shape.compression = Compression::kNone;
  return shape;
}

EncodedChunk encode_chunk(const ArrayView& view, std::int64_t index, Compression compression) {
  const ArrayShape shape = shape_of(view, compression);
  const std::int64_t count = shape.rows_in_chunk(index);
  if (index < 0 || count <= 0) throw std::invalid_argument("chunk index out of range");
  const auto size = static_cast<std::size_t>(count * shape.row_bytes());
  const auto rows = std::make_unique_for_overwrite<std::byte[]>(size);
  gather_rows(view, index * shape.chunk_rows, count, rows.get());
  return encode_rows(shape, {rows.get(), size});
}

EncodedChunk encode_rows(const ArrayShape& shape, std::span<const std::byte> rows) {
  const auto size = static_cast<std::size_t>(shape.chunk_bytes());
  if (rows.empty()) throw std::invalid_argument("a chunk without rows");
  if (rows.size() > size) throw std::invalid_argument("more rows than a chunk holds");
  EncodedChunk chunk;
  chunk.raw_xxh3 = xxh3_64(rows);
  if (shape.compact) {
    chunk.bytes.assign(rows.begin(), rows.end());
    return chunk;
  }
  std::vector<std::byte> padded;
  if (rows.size() < size) {
    padded = with_last_row_repeated(rows, static_cast<std::size_t>(shape.row_bytes()), size);
    rows = padded;
  }
  if (shape.compression == Compression::kNone) {
    chunk.bytes = with_checksum(rows);
    return chunk;
  }
  // One allocation holds the shuffled and the compressed bytes. The latter are used only if they
  // are fewer.
  const auto scratch = std::make_unique_for_overwrite<std::byte[]>(2 * size);
  const auto element_size = static_cast<std::size_t>(size_of(shape.type));
  shuffle(rows, element_size, scratch.get());
  const Compressor compressor(libdeflate_alloc_compressor(kFastest));
  if (!compressor) throw std::bad_alloc();
  const std::span<const std::byte> shuffled(scratch.get(), size);
  const std::size_t noise = noise_in_front(compressor.get(), shuffled, element_size);
  const std::size_t constant =
      std::min(constant_planes_at_back(shuffled, element_size), element_size - noise);
  const std::size_t packed = zlib_stream(compressor.get(), shuffled, size / element_size, noise,
                                         constant, scratch.get() + size);
  if (packed > 0) {
    chunk.bytes = with_checksum({scratch.get() + size, packed});
  } else {
    chunk.bytes = with_checksum(rows);
    chunk.filter_mask = kSkipShuffle | kSkipDeflate;
  }
  return chunk;
}

EncodedArray encode_array(const ArrayView& view, Compression compression) {
  EncodedArray array{shape_of(view, compression), {}};
  const std::int64_t count = array.shape.chunk_count();
  array.chunks.reserve(static_cast<std::size_t>(count));
  for (std::int64_t i = 0; i < count; ++i)
    array.chunks.push_back(encode_chunk(view, i, compression));
  return array;
}

bool decode_chunk(const ArrayShape& shape, std::span<const std::byte> bytes,
                  std::uint32_t filter_mask, std::span<std::byte> rows) {
  if (shape.compact) {
    if (bytes.size() != rows.size()) return false;
    std::ranges::copy(bytes, rows.begin());
    return true;
  }
  if (bytes.size() < kChecksumBytes) return false;
  const std::span<const std::byte> body = bytes.first(bytes.size() - kChecksumBytes);
  std::uint32_t sum = 0;
  std::memcpy(&sum, bytes.data() + body.size(), kChecksumBytes);
  if (sum != fletcher32(body)) return false;

  if (shape.compression == Compression::kNone || filter_mask == (kSkipShuffle | kSkipDeflate)) {
    if (body.size() != rows.size()) return false;
    std::memcpy(rows.data(), body.data(), rows.size());
    return true;
  }
  if (filter_mask != 0) return false;  // no writer of this format skips one filter alone
  const auto element_size = static_cast<std::size_t>(size_of(shape.type));
  if (element_size == 1) return inflate(body, rows);
  const auto shuffled = std::make_unique_for_overwrite<std::byte[]>(rows.size());
  if (!inflate(body, {shuffled.get(), rows.size()})) return false;
  unshuffle({shuffled.get(), rows.size()}, element_size, rows.data());
  return true;
}

}  // namespace semigeo::io
