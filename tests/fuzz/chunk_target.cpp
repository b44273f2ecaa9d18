// A chunk of an array as it lies in an HDF5 file, with its checksum made right again.
#include <cstring>
#include <vector>

#include "io/files/chunk_codec.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

constexpr io::ElementType kTypes[] = {
    io::ElementType::kFloat32, io::ElementType::kFloat64, io::ElementType::kInt32,
    io::ElementType::kInt64,   io::ElementType::kUint8,   io::ElementType::kUint16,
    io::ElementType::kFeature, io::ElementType::kContour, io::ElementType::kPosting};

/// Writes the same rows and reads them back.
void check_round_trip(const io::ArrayShape& shape, std::span<const std::byte> rows) {
  const io::EncodedChunk chunk = io::encode_rows(shape, rows);
  std::vector<std::byte> again(rows.size());
  check(io::decode_chunk(shape, chunk.bytes, chunk.filter_mask, again), "a chunk is not read back");
  check(std::memcmp(again.data(), rows.data(), rows.size()) == 0, "a chunk is read back wrongly");
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  io::ArrayShape shape;
  shape.type = kTypes[numbers.below(std::size(kTypes))];
  shape.columns = static_cast<int>(1 + numbers.below(4));
  shape.chunk_rows = 1 + numbers.below(64);
  shape.rows = shape.chunk_rows;
  shape.compression = numbers.below(2) != 0 ? io::Compression::kDeflate : io::Compression::kNone;
  const unsigned mask = numbers.byte();
  const bool mend = numbers.below(8) != 0;
  const std::string_view rest = numbers.rest();
  std::vector<std::byte> stored(rest.size());
  if (!rest.empty()) std::memcpy(stored.data(), rest.data(), rest.size());
  if (mend) {
    const std::uint32_t sum = io::fletcher32(stored);
    stored.resize(stored.size() + sizeof sum);
    std::memcpy(stored.data() + stored.size() - sizeof sum, &sum, sizeof sum);
  }
  std::vector<std::byte> rows(static_cast<std::size_t>(shape.chunk_bytes()));
  if (io::decode_chunk(shape, stored, mask, rows)) check_round_trip(shape, rows);
}

}  // namespace semigeo::fuzz
