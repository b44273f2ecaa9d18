#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/files/array.hpp"

namespace semigeo::io {

/// Filters of a stored array: `deflate` is shuffle, deflate, fletcher32; `none` is fletcher32
/// alone.
enum class Compression { none, deflate };

/// What is not larger is stored without chunks: their index alone would be as large.
inline constexpr std::int64_t kMostCompactBytes = 4096;

/// One chunk as it lies in the file.
struct EncodedChunk {
  std::vector<std::byte> bytes;
  std::uint32_t filter_mask = 0;  ///< bit i set: filter i of the pipeline was skipped
  std::uint64_t raw_xxh3 = 0;     ///< XXH3_64 of the rows, without the padding of the last chunk
};

/// What a stored array looks like, apart from its values.
struct ArrayShape {
  ElementType type = ElementType::float32;
  std::int64_t rows = 0;
  int columns = 1;
  std::int64_t chunk_rows = 1;
  Compression compression = Compression::none;
  /// Without chunks and filters, in the header of the dataset, which has a checksum. As far as the
  /// codec is concerned one chunk of bytes as they are.
  bool compact = false;

  std::int64_t row_bytes() const { return columns * size_of(type); }
  std::int64_t chunk_bytes() const { return chunk_rows * row_bytes(); }
  std::int64_t chunk_count() const { return (rows + chunk_rows - 1) / chunk_rows; }
  /// Rows that chunk `index` really holds; the last one may be padded.
  std::int64_t rows_in_chunk(std::int64_t index) const {
    const std::int64_t left = rows - index * chunk_rows;
    return left < chunk_rows ? left : chunk_rows;
  }
  friend bool operator==(const ArrayShape&, const ArrayShape&) = default;
};

/// An array ready to be written: shape.chunk_count() chunks.
struct EncodedArray {
  ArrayShape shape;
  std::vector<EncodedChunk> chunks;
};

/// The shape under which a view is stored. Chunks of about 256 KiB: many enough to share among
/// threads, few enough for HDF5's index. Arrays of up to kMostCompactBytes are compact.
ArrayShape shape_of(const ArrayView& view, Compression compression);

/// Encodes chunk `index` of shape_of(view, compression) to the bytes that HDF5's own filters
/// would accept. Pure and thread-safe; throws std::invalid_argument on an unsupported conversion.
EncodedChunk encode_chunk(const ArrayView& view, std::int64_t index, Compression compression);

/// The same for rows that already have their stored form; at most chunk_rows of them.
EncodedChunk encode_rows(const ArrayShape& shape, std::span<const std::byte> rows);

/// Every chunk, one after the other.
EncodedArray encode_array(const ArrayView& view, Compression compression);

/// Undoes encode_rows: the whole chunk, padding included, into `rows`, whose size must be
/// shape.chunk_bytes(). False when the checksum or the compressed stream is wrong. Thread-safe.
bool decode_chunk(const ArrayShape& shape, std::span<const std::byte> bytes,
                  std::uint32_t filter_mask, std::span<std::byte> rows);

/// The checksum of HDF5's fletcher32 filter.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// XXH3_64 of a run of bytes.
std::uint64_t xxh3_64(std::span<const std::byte> bytes);

}  // namespace semigeo::io
