#include "io/hdf5/array_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

namespace semigeo::io {
namespace {

constexpr std::int64_t kBytesAtOnce = 8 << 20;
constexpr std::int64_t kBestDeflateRatio = 1032;  // no deflate stream has a higher ratio

Hdf5File::Array open_checked(const Hdf5File& file, const std::string& path, int columns) {
  Hdf5File::Array array = file.open_array(path);
  const ArrayShape& shape = array.shape();
  if (shape.columns != columns)
    file.refuse(path, "has " + std::to_string(shape.columns) + " columns instead of " +
                          std::to_string(columns));
  if (array.is_virtual()) file.refuse(path, "is virtual: read what it shows");
  if (shape.rows * shape.row_bytes() / kBestDeflateRatio > array.stored_bytes())
    file.refuse(path, "promises " + std::to_string(shape.rows) + " rows but stores only " +
                          std::to_string(array.stored_bytes()) + " bytes");
  return array;
}

void require_type(const Hdf5File::Array& array, ElementType type) {
  const ElementType found = array.shape().type;
  if (found != type)
    array.file().refuse(array.path(), "holds " + std::string(name_of(found)) + " instead of " +
                                          std::string(name_of(type)));
}

/// Returns the rows of a chunk without padding, in a buffer of the size of a chunk.
std::span<const std::byte> decoded(const Hdf5File::Array& array, std::int64_t index,
                                   const EncodedChunk& chunk, std::byte* buffer) {
  const ArrayShape& shape = array.shape();
  const auto size = static_cast<std::size_t>(shape.chunk_bytes());
  if (!decode_chunk(shape, chunk.bytes, chunk.filter_mask, {buffer, size}))
    array.file().refuse(array.path() + ", chunk " + std::to_string(index),
                        "its bytes do not match their checksum");
  return {buffer, static_cast<std::size_t>(shape.rows_in_chunk(index) * shape.row_bytes())};
}

template <typename Stored, typename Result>
void append_rows(const Hdf5File::Array& array, std::vector<Result>& values) {
  for_each_chunk(array, [&](std::span<const std::byte> rows) {
    for (std::size_t at = 0; at < rows.size(); at += sizeof(Stored)) {
      Stored value;
      std::memcpy(&value, rows.data() + at, sizeof value);
      values.push_back(value);
    }
  });
}

template <typename Value>
std::vector<Value> read_values(const Hdf5File& file, const std::string& path, int columns,
                               ElementType type) {
  const Hdf5File::Array array = open_checked(file, path, columns);
  const ElementType found = array.shape().type;
  const bool widens =
      type == ElementType::kInt64 && (found == ElementType::kInt32 || found == ElementType::kUint8);
  if (!widens) require_type(array, type);
  std::vector<Value> values;
  values.reserve(static_cast<std::size_t>(array.shape().rows * columns));
  if constexpr (std::is_same_v<Value, std::int64_t>)
    if (widens) {
      found == ElementType::kInt32 ? append_rows<std::int32_t>(array, values)
                                   : append_rows<std::uint8_t>(array, values);
      return values;
    }
  append_rows<Value>(array, values);
  return values;
}

}  // namespace

void for_each_chunk(const Hdf5File::Array& array,
                    const std::function<void(std::span<const std::byte>)>& use) {
  const ArrayShape& shape = array.shape();
  if (shape.rows == 0) return;
  const auto buffer = std::make_unique_for_overwrite<std::byte[]>(shape.chunk_bytes());
  for (std::int64_t i = 0; i < shape.chunk_count(); ++i)
    use(decoded(array, i, array.read_chunk(i), buffer.get()));
}

void for_each_chunk(const Hdf5File::Array& array, const ForEach& for_each,
                    const std::function<void(std::int64_t, std::span<const std::byte>)>& use) {
  const ArrayShape& shape = array.shape();
  if (!for_each) {
    std::int64_t next = 0;
    return for_each_chunk(array, [&](std::span<const std::byte> rows) { use(next++, rows); });
  }
  if (shape.rows == 0) return;
  const std::int64_t at_once = std::max<std::int64_t>(kBytesAtOnce / shape.chunk_bytes(), 1);
  for (std::int64_t first = 0; first < shape.chunk_count(); first += at_once) {
    const std::int64_t count = std::min(at_once, shape.chunk_count() - first);
    std::vector<EncodedChunk> chunks;  // only one thread at a time may use HDF5
    for (std::int64_t i = 0; i < count; ++i) chunks.push_back(array.read_chunk(first + i));
    for_each(count, [&](std::int64_t i) {
      const auto buffer = std::make_unique_for_overwrite<std::byte[]>(shape.chunk_bytes());
      use(first + i, decoded(array, first + i, chunks[i], buffer.get()));
    });
  }
}

std::vector<float> read_floats(const Hdf5File& file, const std::string& path, int columns) {
  return read_values<float>(file, path, columns, ElementType::kFloat32);
}

std::vector<double> read_doubles(const Hdf5File& file, const std::string& path, int columns) {
  return read_values<double>(file, path, columns, ElementType::kFloat64);
}

std::vector<std::int64_t> read_integers(const Hdf5File& file, const std::string& path,
                                        int columns) {
  return read_values<std::int64_t>(file, path, columns, ElementType::kInt64);
}

std::vector<std::byte> read_records(const Hdf5File& file, const std::string& path,
                                    ElementType type) {
  const Hdf5File::Array array = open_checked(file, path, 1);
  require_type(array, type);
  std::vector<std::byte> records;
  records.reserve(static_cast<std::size_t>(array.shape().rows * array.shape().row_bytes()));
  for_each_chunk(array, [&](std::span<const std::byte> rows) {
    records.insert(records.end(), rows.begin(), rows.end());
  });
  return records;
}

}  // namespace semigeo::io
