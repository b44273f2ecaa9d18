#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "io/files/array.hpp"

namespace semigeo::io {

/// The filters of a stored array. kDeflate is shuffle, deflate, fletcher32; kNone is fletcher32
/// alone.
enum class Compression { kNone, kDeflate };

/// Arrays of at most this number of bytes are stored without chunks: their index alone would be as
/// large.
inline constexpr std::int64_t kMostCompactBytes = 4096;

/// One chunk as it lies in the file.
struct EncodedChunk {
  std::vector<std::byte> bytes;
  std::uint32_t filter_mask = 0;  ///< If bit i is set, filter i of the pipeline was skipped.
  std::uint64_t raw_xxh3 = 0;     ///< XXH3_64 of the rows, without the padding of the last chunk.
};

/// Describes what a stored array looks like, apart from its values.
struct ArrayShape {
  ElementType type = ElementType::kFloat32;
  std::int64_t rows = 0;
  int columns = 1;
  std::int64_t chunk_rows = 1;
  Compression compression = Compression::kNone;
  /// If true, the array has no chunks and filters: it lies in the header of the dataset, which has
  /// a checksum. For the codec it is one chunk of bytes as they are.
  bool compact = false;

  std::int64_t row_bytes() const { return columns * size_of(type); }
  std::int64_t chunk_bytes() const { return chunk_rows * row_bytes(); }
  std::int64_t chunk_count() const { return (rows + chunk_rows - 1) / chunk_rows; }
  /// Returns how many rows chunk `index` really holds; the last one may be padded.
  std::int64_t rows_in_chunk(std::int64_t index) const {
    const std::int64_t left = rows - index * chunk_rows;
    return left < chunk_rows ? left : chunk_rows;
  }
  friend bool operator==(const ArrayShape&, const ArrayShape&) = default;
};

/// An array ready to be written. It has shape.chunk_count() chunks.
struct EncodedArray {
  ArrayShape shape;
  std::vector<EncodedChunk> chunks;
};

/// Returns the shape under which a view is stored. Chunks have at most 256 KiB, and equal shares of
/// the rows: there are enough of them to share among threads, and few enough for HDF5's index.
/// Arrays of up to kMostCompactBytes are compact.
ArrayShape shape_of(const ArrayView& view, Compression compression);

/// Encodes chunk `index` of shape_of(view, compression) to the bytes that HDF5's own filters would
/// accept. The function is pure and thread-safe. Throws std::invalid_argument on an unsupported
/// conversion.
EncodedChunk encode_chunk(const ArrayView& view, std::int64_t index, Compression compression);

/// Encodes rows that already have their stored form: at least one, and at most chunk_rows of them.
/// Fewer are padded with copies of the last one. The function is pure and thread-safe. Throws
/// std::invalid_argument on other numbers of rows.
EncodedChunk encode_rows(const ArrayShape& shape, std::span<const std::byte> rows);

/// Encodes every chunk, one after the other.
EncodedArray encode_array(const ArrayView& view, Compression compression);

/// Decodes what encode_rows returns. The whole chunk, padding included, is written to `rows`, whose
/// size must be shape.chunk_bytes(). Returns false if the checksum or the compressed stream is
/// wrong. The function is thread-safe.
bool decode_chunk(const ArrayShape& shape, std::span<const std::byte> bytes,
                  std::uint32_t filter_mask, std::span<std::byte> rows);

/// Returns the checksum of HDF5's fletcher32 filter.
std::uint32_t fletcher32(std::span<const std::byte> bytes);

/// Returns the XXH3_64 of a run of bytes.
std::uint64_t xxh3_64(std::span<const std::byte> bytes);

}  // namespace semigeo::io
