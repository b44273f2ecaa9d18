#include "io/scans/pcd_header.hpp"

#include <optional>
#include <string_view>

#include "io/scans/scan_builder.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kBadHeader = "correct the header or export the scan again";
constexpr std::int64_t kMostHeaderLines = 1000;
constexpr std::int64_t kMostFields = 1000;
constexpr std::int64_t kMostPoints = std::int64_t{1} << 40;

/// What the lines of a header say, before it is checked.
struct Lines {
  std::optional<std::int64_t> width, height, points;
  std::size_t sizes = 0, types = 0, counts = 0;  // numbers of values
};

void read_fields(TextScanner& scanner, PcdHeader& header) {
  header.fields.clear();
  while (!scanner.at_line_end()) {
    if (std::ssize(header.fields) == kMostFields)
      scanner.fail("the header has more than " + std::to_string(kMostFields) + " fields",
                   kBadHeader);
    header.fields.push_back({.name = std::string(scanner.word())});
  }
}

/// Calls read(field) for each field that the line has a value for. Returns their number. Throws
/// Error if the line has more values.
template <typename Read>
std::size_t read_each(TextScanner& scanner, PcdHeader& header, Read read) {
  std::size_t count = 0;
  for (; !scanner.at_line_end(); ++count) {
    if (count == header.fields.size())
      scanner.fail("the line has more values than FIELDS has names", kBadHeader);
    read(header.fields[count]);
  }
  return count;
}

std::int64_t read_count(TextScanner& scanner, std::string_view what, std::int64_t most) {
  const std::int64_t value = scanner.integer(what);
  if (value < 0 || value > most)
    scanner.fail(std::string(what) + " is not in 0 ... " + std::to_string(most), kBadHeader);
  return value;
}

void read_encoding(TextScanner& scanner, PcdHeader& header) {
  const std::string name(scanner.word());
  if (name == "ascii") {
    header.encoding = PcdHeader::Encoding::kAscii;
  } else if (name == "binary") {
    header.encoding = PcdHeader::Encoding::kBinary;
  } else if (name == "binary_compressed") {
    header.encoding = PcdHeader::Encoding::kCompressed;
  } else {
    scanner.fail("unknown PCD encoding '" + name.substr(0, 40) + "'",
                 "export it as ascii, binary or binary_compressed");
  }
}

/// Reads one line. Returns false if it was the last one.
bool read_line(TextScanner& scanner, PcdHeader& header, Lines& lines) {
  const std::string keyword(scanner.word());
  if (keyword == "FIELDS") {
    read_fields(scanner, header);
  } else if (keyword == "SIZE") {
    lines.sizes = read_each(scanner, header, [&](PcdField& field) {
      field.size = read_count(scanner, "the size of a field", 8);
    });
  } else if (keyword == "TYPE") {
    lines.types =
        read_each(scanner, header, [&](PcdField& field) { field.type = scanner.word().front(); });
  } else if (keyword == "COUNT") {
    lines.counts = read_each(scanner, header, [&](PcdField& field) {
      field.count = read_count(scanner, "the count of a field", 1 << 16);
    });
  } else if (keyword == "WIDTH") {
    lines.width = read_count(scanner, "WIDTH", kMostPoints);
  } else if (keyword == "HEIGHT") {
    lines.height = read_count(scanner, "HEIGHT", kMostPoints);
  } else if (keyword == "POINTS") {
    lines.points = read_count(scanner, "POINTS", kMostPoints);
  } else if (keyword == "VIEWPOINT") {
    for (int i = 0; i < 3; ++i) header.eye[i] = scanner.number("the viewpoint");
  } else if (keyword == "DATA") {
    read_encoding(scanner, header);
    return false;
  } else if (keyword != "VERSION") {
    ++header.unknown_lines;
  }
  return true;
}

void check_grid(const TextScanner& scanner, PcdHeader& header, const Lines& lines) {
  if (!lines.width || !lines.height)
    scanner.fail("the header has no WIDTH or no HEIGHT", kBadHeader);
  header.width = *lines.width;
  header.height = *lines.height;
  if (header.height == 1 && header.width > 0)
    scanner.fail("it is a point cloud without order (HEIGHT 1)", ScanBuilder::kNeedsSurface);
  if (header.width == 0 || header.height == 0) scanner.fail("it holds no points", kBadHeader);
  if (header.width > kMostPoints / header.height)
    scanner.fail("WIDTH times HEIGHT is out of range", kBadHeader);
  if (lines.points && *lines.points != header.width * header.height)
    scanner.fail("POINTS is " + std::to_string(*lines.points) + ", but WIDTH times HEIGHT is " +
                     std::to_string(header.width * header.height),
                 kBadHeader);
}

void check_fields(const TextScanner& scanner, PcdHeader& header, const Lines& lines) {
  const std::size_t count = header.fields.size();
  const bool binary = header.encoding != PcdHeader::Encoding::kAscii;
  for (const std::size_t values : {lines.sizes, lines.types, lines.counts})
    if (values != count && values != 0)
      scanner.fail("SIZE, TYPE or COUNT has fewer values than FIELDS has names", kBadHeader);
  if (binary && (lines.sizes == 0 || lines.types == 0))
    scanner.fail("the header has no SIZE or no TYPE", kBadHeader);
  std::int64_t column = 0;
  for (std::size_t i = 0; i < count; ++i) {
    PcdField& field = header.fields[i];
    field.offset = header.point_bytes;
    field.column = column;
    header.point_bytes += field.size * field.count;
    column += field.count;
    for (int axis = 0; axis < 3; ++axis)
      if (field.name == std::string_view("xyz").substr(axis, 1) && header.axes[axis] < 0)
        header.axes[axis] = static_cast<std::int64_t>(i);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (header.axes[axis] < 0)
      scanner.fail("its points have no field " + std::string("xyz").substr(axis, 1), kBadHeader);
    const PcdField& field = header.axis(axis);
    if (field.count != 1 || (binary && (field.type != 'F' || (field.size != 4 && field.size != 8))))
      scanner.fail("the field " + field.name + " is not one floating-point number", kBadHeader);
  }
  if (header.point_bytes > static_cast<std::int64_t>(ByteSource::kWindowBytes))
    scanner.fail("a point has more than 1 MiB", kBadHeader);
}

}  // namespace

PcdHeader read_pcd_header(ByteSource& source) {
  TextScanner scanner(source, {.hash_comments = true});
  PcdHeader header;
  Lines lines;
  for (bool more = true; more;) {
    if (!scanner.at_line_end()) more = read_line(scanner, header, lines);
    if (!more) break;
    if (header.unknown_lines > 0 && header.fields.empty())
      scanner.fail("this is not a PCD file: it does not begin with a PCD header",
                   "correct its extension");
    if (!scanner.next_line())
      scanner.fail("the file ends within its header", "copy the file again from its source");
    if (scanner.line() > kMostHeaderLines)
      scanner.fail("the header has more than " + std::to_string(kMostHeaderLines) + " lines",
                   kBadHeader);
  }
  check_grid(scanner, header, lines);
  check_fields(scanner, header, lines);
  if (!scanner.next_line())
    scanner.fail("the file ends after its header", "copy the file again from its source");
  header.lines = scanner.line() - 1;
  scanner.release();
  return header;
}

}  // namespace semigeo::io
