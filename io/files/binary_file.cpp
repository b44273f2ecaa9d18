#include "io/files/binary_file.hpp"

#include <array>

#include "io/files/binary_load.hpp"
#include "io/files/chunk_codec.hpp"
#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kStartBytes = kMagicBytes + 4;  // magic, version
constexpr std::size_t kTrailerBytes = 8 + 8 + 8;      // size and hash of the head, hash of these

std::uint64_t hash_of(std::string_view bytes) {
  return xxh3_64(std::as_bytes(std::span(bytes)));
}

template <typename Number>
Number little(const char* from) {
  return load<Number>(from, std::endian::little);
}

}  // namespace

BinaryWriter::BinaryWriter(const std::filesystem::path& path, const BinaryFormat& format)
    : file_(path) {
  file_.text(format.magic);
  file_.number(format.version);
}

void BinaryWriter::data(std::span<const std::byte> bytes) {
  file_.text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void BinaryWriter::write_end(const HeadWriter& head) {
  HeadWriter trailer;
  trailer.number<std::uint64_t>(head.bytes().size());
  trailer.number(hash_of(head.bytes()));
  trailer.number(hash_of(trailer.bytes()));
  file_.text(head.bytes());
  file_.text(trailer.bytes());
}

void BinaryWriter::finish(const HeadWriter& head) {
  write_end(head);
  file_.commit();
}

void BinaryWriter::finish_unsynced(const HeadWriter& head) {
  write_end(head);
  file_.commit_unsynced();
}

BinaryFile::BinaryFile(const std::filesystem::path& path, const BinaryFormat& format)
    : file_(path) {
  const auto size = static_cast<std::uint64_t>(file_.size());
  std::array<char, kStartBytes> start = {};
  if (file_.read_at(0, start) != start.size() ||
      std::string_view(start.data(), kMagicBytes) != format.magic)
    throw Error(path, "", std::string("is not ") + format.noun, "remove it and run again");
  const auto version = little<std::uint32_t>(start.data() + kMagicBytes);
  if (version != format.version)
    throw Error(path, "",
                "is version " + std::to_string(version) + " of " + format.noun +
                    ", this program reads " + std::to_string(format.version),
                "remove it and run again");
  if (size < kStartBytes + kTrailerBytes) refuse("", "ends too early");
  std::array<char, kTrailerBytes> trailer = {};
  if (file_.read_at(size - trailer.size(), trailer) != trailer.size() ||
      hash_of({trailer.data(), 16}) != little<std::uint64_t>(trailer.data() + 16))
    refuse("", "has not the end that it should have");
  const auto head_bytes = little<std::uint64_t>(trailer.data());
  head_hash_ = little<std::uint64_t>(trailer.data() + 8);
  if (head_bytes > size - kStartBytes - kTrailerBytes) refuse("", "is shorter than it says");
  head_.resize(head_bytes);
  if (file_.read_at(size - kTrailerBytes - head_bytes, head_) != head_bytes ||
      hash_of(head_) != head_hash_)
    refuse("head", "its bytes do not match their checksum");
  data_bytes_ = size - kTrailerBytes - head_bytes - kStartBytes;
}

void BinaryFile::take(void* to, std::size_t bytes) {
  if (bytes > head_.size() - taken_) refuse("head", "ends too early");
  if (bytes > 0) std::memcpy(to, head_.data() + taken_, bytes);  // `to` may be null otherwise
  taken_ += bytes;
}

std::string BinaryFile::text() {
  const std::vector<char> text = numbers<char>(number<std::uint32_t>());
  return {text.begin(), text.end()};
}

void BinaryFile::end_of_head() {
  if (taken_ != head_.size()) refuse("head", "is longer than it should be");
  head_ = {};
  taken_ = 0;
}

std::vector<std::byte> BinaryFile::read(std::uint64_t offset, std::uint64_t bytes) const {
  if (offset > data_bytes_ || bytes > data_bytes_ - offset)
    refuse("byte " + std::to_string(offset), "is beyond the end of the data");
  std::vector<std::byte> result(bytes);
  if (file_.read_at(kStartBytes + offset,
                    {reinterpret_cast<char*>(result.data()), result.size()}) != bytes)
    refuse("byte " + std::to_string(offset), "cannot be read: the file has become shorter");
  return result;
}

void BinaryFile::refuse(const std::string& place, const std::string& problem) const {
  throw Error(path(), place, problem, "the file is damaged: remove it and run again");
}

}  // namespace semigeo::io
