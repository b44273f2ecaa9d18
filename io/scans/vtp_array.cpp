#include "io/scans/vtp_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "io/files/base64.hpp"
#include "io/files/binary_load.hpp"
#include "io/files/printable.hpp"
#include "io/scans/decimal.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kExportAgain = "copy the file again from its source or export it again";
constexpr std::int64_t kMostRatio = 1100;  // deflate reaches 1032 with zeros

using Kind = VtkType::Kind;
constexpr std::array<std::pair<std::string_view, VtkType>, 10> kTypes = {{
    {"Float32", {Kind::kFloat, 4}},
    {"Float64", {Kind::kFloat, 8}},
    {"Int8", {Kind::kSigned, 1}},
    {"UInt8", {Kind::kUnsigned, 1}},
    {"Int16", {Kind::kSigned, 2}},
    {"UInt16", {Kind::kUnsigned, 2}},
    {"Int32", {Kind::kSigned, 4}},
    {"UInt32", {Kind::kUnsigned, 4}},
    {"Int64", {Kind::kSigned, 8}},
    {"UInt64", {Kind::kUnsigned, 8}},
}};

/// The bytes of an array, raw or as Base64, from front to back.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool base64) : text_(text), decoder_(text), base64_(base64) {}

  /// Returns up to this number of bytes: fewer only at the end.
  std::string read(std::int64_t count) {
    std::string bytes;
    if (base64_) {
      decoder_.read(static_cast<std::size_t>(count), bytes);
    } else {
      bytes = text_.substr(0, static_cast<std::size_t>(count));
      text_.remove_prefix(bytes.size());
    }
    return bytes;
  }

 private:
  std::string_view text_;
  Base64Decoder decoder_;
  bool base64_;
};

/// Reads the header and the blocks of an array. Returns nothing if they are damaged.
class ArrayBytes {
 public:
  ArrayBytes(EncodedBytes& encoded, const VtpEncoding& encoding)
      : encoded_(encoded), encoding_(encoding) {}

  std::optional<std::string> read(std::int64_t most) {
    if (encoding_.compressed) return read_blocks(most);
    const std::optional<std::int64_t> size = next();
    if (!size) return std::nullopt;
    std::string bytes = encoded_.read(std::min(*size, most));
    if (std::ssize(bytes) < std::min(*size, most)) return std::nullopt;
    return bytes;
  }

 private:
  /// Returns the next number of the header, or nothing if it is absent or absurd.
  std::optional<std::int64_t> next() {
    const std::string bytes = encoded_.read(encoding_.header_bytes);
    if (std::ssize(bytes) < encoding_.header_bytes) return std::nullopt;
    const VtkType type{Kind::kUnsigned, encoding_.header_bytes};
    const auto number = type.load_from<std::int64_t>(bytes.data(), encoding_.order);
    if (number < 0) return std::nullopt;
    return number;
  }

  /// Reads the number of blocks, the size of a block and that of the last one if it is smaller, the
  /// compressed size of each block, and the blocks.
  std::optional<std::string> read_blocks(std::int64_t most) {
    const auto count = next(), block_size = next(), last_size = next();
    if (!count || !block_size || !last_size) return std::nullopt;
    std::vector<std::int64_t> packed_sizes;
    for (std::int64_t i = 0; i < *count; ++i) {
      const auto size = next();
      if (!size) return std::nullopt;
      packed_sizes.push_back(*size);
    }
    std::string bytes;
    for (std::int64_t i = 0; i < *count && std::ssize(bytes) < most; ++i) {
      const bool is_last = i + 1 == *count && *last_size > 0;
      if (!append_block(packed_sizes[i], is_last ? *last_size : *block_size, bytes))
        return std::nullopt;
    }
    return bytes;
  }

  bool append_block(std::int64_t packed_size, std::int64_t size, std::string& bytes) {
    const std::string packed = encoded_.read(packed_size);
    if (std::ssize(packed) < packed_size || size / kMostRatio > packed_size) return false;
    const std::size_t before = bytes.size();
    bytes.resize(before + static_cast<std::size_t>(size));
    auto unpacked = static_cast<uLongf>(size);
    return uncompress(reinterpret_cast<Bytef*>(bytes.data() + before), &unpacked,
                      reinterpret_cast<const Bytef*>(packed.data()),
                      static_cast<uLong>(packed.size())) == Z_OK &&
           unpacked == static_cast<uLongf>(size);
  }

  EncodedBytes& encoded_;
  const VtpEncoding& encoding_;
};

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

}  // namespace

void VtpArrays::fail(pugi::xml_node array, const std::string& problem,
                     const std::string& remedy) const {
  const std::string name = array.attribute("Name").as_string(array.parent().name());
  builder_.fail({Place::Unit::kByte, array.offset_debug()},
                "the array '" + printable(name.substr(0, 40)) + "' " + problem,
                remedy.empty() ? kExportAgain : remedy);
}

VtkType VtpArrays::type_of(pugi::xml_node array) const {
  const std::string_view name = array.attribute("type").as_string();
  const auto* const known =
      std::ranges::find(kTypes, name, &std::pair<std::string_view, VtkType>::first);
  if (known == kTypes.end()) fail(array, "has a type that is not one of numbers");
  return known->second;
}

std::vector<double> VtpArrays::numbers(pugi::xml_node array, std::int64_t count) const {
  return read<double>(array, count);
}

std::vector<std::int64_t> VtpArrays::integers(pugi::xml_node array, std::int64_t count) const {
  if (type_of(array).kind == Kind::kFloat) fail(array, "does not hold whole numbers");
  return read<std::int64_t>(array, count);
}

template <typename Number>
std::vector<Number> VtpArrays::read(pugi::xml_node array, std::int64_t count) const {
  const VtkType type = type_of(array);
  std::vector<Number> numbers;
  if (std::string_view(array.attribute("format").as_string("ascii")) == "ascii") {
    numbers = read_ascii<Number>(array, count);
  } else {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 8;
    const std::int64_t wanted = count < 0 ? kMost : count;
    const std::string bytes = bytes_of(array, std::min(wanted, kMost) * type.bytes);
    const std::int64_t found = std::min(std::ssize(bytes) / type.bytes, wanted);
    for (std::int64_t i = 0; i < found; ++i)
      numbers.push_back(type.load_from<Number>(bytes.data() + i * type.bytes, encoding_.order));
  }
  if (std::ssize(numbers) < count)
    fail(array, "holds " + std::to_string(numbers.size()) + " numbers, not the " +
                    std::to_string(count) + " that its piece promises");
  return numbers;
}

template <typename Number>
std::vector<Number> VtpArrays::read_ascii(pugi::xml_node array, std::int64_t count) const {
  const std::string_view text = array.text().get();
  std::vector<Number> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (count < 0 || std::ssize(numbers) < count) {
    while (at != end && is_blank(*at)) ++at;
    if (at == end) break;
    Number number{};
    const char* stop = at;
    if constexpr (std::is_same_v<Number, double>) {
      const Decimal decimal = parse_decimal({at, static_cast<std::size_t>(end - at)});
      number = decimal.value;
      stop = decimal.end;
    } else {
      const auto [last, status] = std::from_chars(at, end, number);
      if (status == std::errc{}) stop = last;
    }
    if (stop == at || (stop != end && !is_blank(*stop)))
      fail(array, "has something that is not a number behind " + std::to_string(numbers.size()) +
                      " numbers");
    numbers.push_back(number);
    at = stop;
  }
  return numbers;
}

std::string VtpArrays::bytes_of(pugi::xml_node array, std::int64_t most) const {
  const std::string_view format = array.attribute("format").as_string();
  std::string_view text = array.text().get();
  bool base64 = true;
  if (format == "appended") {
    const auto offset = array.attribute("offset").as_ullong(~0ULL);
    if (offset > encoding_.appended.size()) fail(array, "begins behind the end of the file");
    text = encoding_.appended.substr(static_cast<std::size_t>(offset));
    base64 = encoding_.appended_is_base64;
  } else if (format != "binary") {
    fail(array,
         "has the format '" + printable(std::string(format.substr(0, 40))) + "', which is unknown");
  }
  EncodedBytes encoded(text, base64);
  std::optional<std::string> bytes = ArrayBytes(encoded, encoding_).read(most);
  if (!bytes) fail(array, "is damaged or ends early");
  return std::move(*bytes);
}

}  // namespace semigeo::io
