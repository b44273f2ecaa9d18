#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <string_view>

#include "io/files/binary_load.hpp"
#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kHeaderBytes = 80;
constexpr std::int64_t kPreambleBytes = kHeaderBytes + 4;
constexpr std::int64_t kRecordBytes = 50;
constexpr const char* kMendLine = "correct the line or export the scan again";

bool is_word(std::string_view text, std::string_view word) {
  return std::ranges::equal(text, word, [](char a, char b) { return lower_case(a) == b; });
}

/// Returns whether the file is text. The keyword alone does not tell, because the free header of a
/// binary file may begin with it. But binary data with a triangle is never all text, because of the
/// four bytes of the count and the numbers around zero.
bool is_text(ByteSource& source) {
  source.fill(kPreambleBytes + kRecordBytes);
  std::string_view start = source.ahead().substr(0, 1024);
  // Old systems mark the end of a text by ^Z, and some writers by NUL.
  start = start.substr(0, start.find_last_not_of(std::string_view("\x1a\0", 2)) + 1);
  const bool controls = std::any_of(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' && (c < '\t' || c > '\r');
  });
  if (controls) return false;
  if (start.starts_with("\xef\xbb\xbf")) start.remove_prefix(3);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  return is_word(start.substr(0, 5), "solid") || is_word(start.substr(0, 5), "facet");
}

std::int64_t promised_triangles(const ByteSource& source) {
  return load<std::uint32_t>(source.ahead().data() + kHeaderBytes, std::endian::little);
}

/// Returns whether a plain file has exactly the size that its count of triangles asks for.
bool has_binary_size(ByteSource& source) {
  if (!source.bytes_left() || !source.fill(kPreambleBytes)) return false;
  return source.bytes_left() == kPreambleBytes + kRecordBytes * promised_triangles(source);
}

void add_triangle(ScanBuilder& builder, Place place) {
  const std::int64_t end = builder.point_count();
  builder.add_face(std::array{end - 3, end - 2, end - 1}, place);
}

class StlText {
 public:
  StlText(ByteSource& source, ScanBuilder& builder) : scanner_(source), builder_(builder) {}

  void read() {
    while (scanner_.skip_to_content()) {
      read_line();
      if (!scanner_.next_line()) break;
    }
    if (in_facet_)
      scanner_.fail("the file ends before its endfacet", "copy the file again from its source");
  }

 private:
  void read_line() {
    std::string keyword(scanner_.word());
    if (is_word(keyword, "end")) keyword += scanner_.word();  // "end loop"
    if (passed_over(keyword)) return;
    if (is_word(keyword, "vertex")) {
      read_vertex();
    } else if (is_word(keyword, "facet")) {
      expect(!in_facet_);
      in_facet_ = true;
    } else if (is_word(keyword, "outer")) {
      expect(in_facet_ && !in_loop_);
      in_loop_ = true;
      corners_ = 0;
    } else if (is_word(keyword, "endloop")) {
      expect(in_loop_);
      in_loop_ = false;
      if (corners_ != 3)
        scanner_.fail("a facet has " + std::to_string(corners_) + " vertices in place of three",
                      kMendLine);
      add_triangle(builder_, place());
    } else if (is_word(keyword, "endfacet")) {
      expect(in_facet_ && !in_loop_);
      in_facet_ = false;
    } else if (is_word(keyword, "solid")) {
      expect(!in_facet_);  // the one before may have no end
      in_solid_ = true;
    } else {
      expect(is_word(keyword, "endsolid") && !in_facet_);
      in_solid_ = false;
    }
  }

  /// Tells whether the line says nothing about the surface: a comment, a colour, an end mark.
  static bool passed_over(std::string_view keyword) {
    return is_word(keyword, "color") || keyword.starts_with('#') || keyword.starts_with("//") ||
           keyword.find_first_not_of(std::string_view("\x1a\0", 2)) == std::string_view::npos;
  }

  void read_vertex() {
    expect(in_loop_);
    const double x = scanner_.number("the x coordinate");
    const double y = scanner_.number("the y coordinate");
    const double z = scanner_.number("the z coordinate");
    builder_.add_point(x, y, z, place());
    ++corners_;
  }

  Place place() const { return {Place::Unit::kLine, scanner_.line()}; }

  void expect(bool condition) const {
    if (condition) return;
    const char* expected = "solid or facet";
    if (in_solid_) expected = "facet or endsolid";
    if (in_facet_) expected = "outer loop or endfacet";
    if (in_loop_) expected = "vertex or endloop";
    scanner_.fail(std::string("the line does not begin with ") + expected, kMendLine);
  }

  TextScanner scanner_;
  ScanBuilder& builder_;
  std::int64_t corners_ = 0;
  bool in_solid_ = false, in_facet_ = false, in_loop_ = false;
};

/// Returns how many triangles follow the count that has just been read. If the size of the file and
/// the count disagree, and the rest of the file is whole records, the size decides.
std::int64_t triangles_ahead(const ByteSource& source, const ScanBuilder& builder,
                             std::int64_t count) {
  if (!source.bytes_left()) return count;  // compressed
  const std::int64_t left = *source.bytes_left();
  const bool whole_records = left > 0 && left % kRecordBytes == 0;
  if (left < kRecordBytes * count && !whole_records)
    builder.fail_promise("triangles", count, left / kRecordBytes,
                         {Place::Unit::kByte, source.position() + left});
  if (left < kRecordBytes * count || (count == 0 && whole_records)) return left / kRecordBytes;
  return count;
}

/// Tells whether another solid follows, with a header and as many records as it counts, and at the
/// end of the file or before room for one more.
bool is_followed_by_solid(ByteSource& source) {
  if (!source.bytes_left() || !source.fill(kPreambleBytes)) return false;
  const std::int64_t count = promised_triangles(source);
  const std::int64_t rest = *source.bytes_left() - kPreambleBytes - kRecordBytes * count;
  return count > 0 && (rest == 0 || rest >= kPreambleBytes + kRecordBytes);
}

void read_solid(ByteSource& source, ScanBuilder& builder) {
  const Place count_place{Place::Unit::kByte, source.position() + kHeaderBytes};
  const std::int64_t promised = promised_triangles(source);
  source.consume(kPreambleBytes);
  // It is checked before reading, because another kind of file would give a confusing message.
  const std::int64_t count = triangles_ahead(source, builder, promised);
  if (count != promised) builder.add_wrong_count();
  builder.promise_faces(count, kRecordBytes, count_place);
  builder.promise_points(builder.point_count() + 3 * count, kRecordBytes / 3, count_place);
  for (std::int64_t i = 0; i < count; ++i) {
    if (!source.fill(kRecordBytes)) {
      source.skip(kRecordBytes);
      builder.fail_promise("triangles", count, i, {Place::Unit::kByte, source.position()});
    }
    const Place place{Place::Unit::kByte, source.position()};
    const char* const corners = source.ahead().data() + 12;  // the corners follow the normal
    std::array<float, 9> xyz;
    for (int k = 0; k < 9; ++k) xyz[k] = load<float>(corners + 4 * k, std::endian::little);
    for (int k = 0; k < 9; k += 3) builder.add_point(xyz[k], xyz[k + 1], xyz[k + 2], place);
    add_triangle(builder, place);
    source.consume(kRecordBytes);
  }
}

void read_binary(ByteSource& source, ScanBuilder& builder) {
  if (!source.fill(kPreambleBytes))
    throw Error(source.path(), "",
                "this is no STL file: it is neither text that begins with 'solid' nor long enough "
                "to be binary",
                "copy it again from its source or correct its extension");
  do {
    read_solid(source, builder);
  } while (is_followed_by_solid(source));
}

Scan read_stl(ByteSource& source, const ScanOptions& options) {
  ScanBuilder builder(source, options);
  if (!has_binary_size(source) && is_text(source)) {
    StlText(source, builder).read();
    return builder.finish("STL ascii");
  }
  read_binary(source, builder);
  return builder.finish("STL binary");
}

std::string variant_of(std::string_view begin) {
  // The header of a binary file may begin with the same word, but its numbers contain zeros.
  return begin.starts_with("solid") && begin.find('\0') == std::string_view::npos ? "STL ascii"
                                                                                  : "STL binary";
}

}  // namespace

const ScanFormat kStlFormat = {.extension = ".stl",
                               .read = read_stl,
                               .variant = variant_of,
                               .content = "meshes",
                               .variants = "ascii, binary"};

}  // namespace semigeo::io
