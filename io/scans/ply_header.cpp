#include "io/scans/ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kMaxHeaderLines = 10'000;
constexpr const char* kBadHeader = "correct the header or export the scan again";

constexpr std::array<std::pair<std::string_view, PlyType>, 18> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"int64", PlyType::kInt64},
    {"uint64", PlyType::kUint64},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

PlyType read_type(TextScanner& scanner) {
  const std::string_view word = scanner.peek();
  const auto* const entry =
      std::find_if(kTypeNames.begin(), kTypeNames.end(),
                   [&](const auto& candidate) { return candidate.first == word; });
  if (entry == kTypeNames.end()) {
    if (word.empty()) scanner.fail("a property has no type", kBadHeader);
    scanner.fail("unknown property type '" + std::string(word.substr(0, 40)) + "'", kBadHeader);
  }
  scanner.word();
  return entry->second;
}

PlyHeader::Encoding read_encoding(TextScanner& scanner) {
  const std::string name(scanner.word());
  const std::string version(scanner.word());
  if (version != "1.0") scanner.fail("unsupported PLY version '" + version.substr(0, 40) + "'");
  if (name == "ascii") return PlyHeader::Encoding::kAscii;
  if (name == "binary_little_endian") return PlyHeader::Encoding::kLittleEndian;
  if (name == "binary_big_endian") return PlyHeader::Encoding::kBigEndian;
  scanner.fail("unknown PLY encoding '" + name.substr(0, 40) + "'",
               "export it as ascii, binary_little_endian or binary_big_endian");
}

PlyElement read_element(TextScanner& scanner) {
  PlyElement element;
  element.line = scanner.line();
  element.name = scanner.word();
  element.count = scanner.integer("the element's count");
  if (element.count < 0) scanner.fail("the element's count is negative", kBadHeader);
  return element;
}

PlyProperty read_property(TextScanner& scanner) {
  PlyProperty property;
  if (scanner.peek() == "list") {
    scanner.word();
    property.count_type = read_type(scanner);
    if (!is_integer(*property.count_type))
      scanner.fail("the length of a list must have an integer type", kBadHeader);
  }
  property.type = read_type(scanner);
  property.name = scanner.word();
  if (property.name.empty()) scanner.fail("a property has no name", kBadHeader);
  return property;
}

/// Reads what follows `obj_info`. Only the size of a range grid means something.
void read_info(TextScanner& scanner, PlyHeader& header) {
  const std::string_view name = scanner.word();
  const bool is_rows = name == "num_rows";
  if (!is_rows && name != "num_cols") return;
  const std::string_view text = scanner.word();
  std::int64_t value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc{} && end == text.data() + text.size())
    (is_rows ? header.grid_rows : header.grid_columns) = value;
}

/// Reads one line. Returns false if it was the last one.
bool read_line(TextScanner& scanner, PlyHeader& header, bool& encoding_known) {
  const std::string keyword(scanner.word());
  if (keyword == "end_header") return false;
  if (keyword == "comment") return true;
  if (keyword == "format") {
    header.encoding = read_encoding(scanner);
    encoding_known = true;
  } else if (keyword == "element") {
    header.elements.push_back(read_element(scanner));
  } else if (keyword == "property") {
    if (header.elements.empty()) scanner.fail("a property stands before any element", kBadHeader);
    header.elements.back().properties.push_back(read_property(scanner));
  } else if (keyword == "obj_info") {
    read_info(scanner, header);
  } else {
    ++header.unknown_lines;
  }
  return true;
}

}  // namespace

int ply_type_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kInt64:
    case PlyType::kUint64:
    case PlyType::kFloat64:
      return 8;
  }
  return 0;
}

std::int64_t PlyElement::least_bytes(bool ascii) const {
  std::int64_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += ascii ? 2 : ply_type_size(property.count_type.value_or(property.type));
  if (ascii && bytes > 0) --bytes;  // the file's last line may lack its end
  return bytes;
}

PlyHeader read_ply_header(ByteSource& source) {
  TextScanner scanner(source);
  // `peek` is not used, because the first word of another binary file may have any length.
  const std::string_view start = source.ahead();
  if (start.substr(0, 3) != "ply" && start.substr(0, 6) != "\xef\xbb\xbfply")
    scanner.fail("this is not a PLY file: it does not begin with 'ply'", "correct its extension");
  if (scanner.word() != "ply") scanner.fail("the first line is not 'ply'", "correct its extension");

  PlyHeader header;
  bool encoding_known = false;
  for (bool more = true; more;) {
    if (!scanner.next_line())
      scanner.fail("the file ends within its header", "copy the file again from its source");
    if (scanner.line() > kMaxHeaderLines)
      scanner.fail("the header has more than " + std::to_string(kMaxHeaderLines) + " lines",
                   kBadHeader);
    if (!scanner.at_line_end()) more = read_line(scanner, header, encoding_known);
  }
  if (!encoding_known) scanner.fail("the header has no 'format' line", kBadHeader);
  if (!scanner.next_line())
    scanner.fail("the file ends after its header", "copy the file again from its source");
  header.lines = scanner.line() - 1;
  scanner.release();
  return header;
}

}  // namespace semigeo::io
