#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/binary_load.hpp"
#include "io/scans/decimal.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kMendLine = "correct the line or export the scan again";

struct OffHeader {
  std::string keyword = "OFF";  ///< Its prefixes add data to vertices: "STCNOFF".
  bool binary = false;
  std::int64_t vertex_bytes = 12;  ///< Bytes of a binary vertex, with the data of prefixes.
  bool homogeneous = false;  ///< Vertices have a fourth coordinate, by which they are divided.
  bool normals = false;      ///< Normals follow the coordinates.
  bool colours = false;      ///< Colours follow them.
};

/// Reads the keyword, which may be absent.
OffHeader read_keyword(TextScanner& scanner) {
  const std::string_view word = scanner.peek();
  OffHeader header;
  if (word.find_first_not_of("0123456789") == std::string_view::npos) return header;
  std::string keyword(word);
  // Some writers use small letters, and some put the first count right behind the keyword.
  const auto is_small = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto is_capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (std::none_of(keyword.begin(), keyword.end(), is_capital))
    for (char& c : keyword)
      if (is_small(c)) c = static_cast<char>(c - 'a' + 'A');
  const std::size_t off = keyword.find("OFF");
  const bool glued = off != std::string::npos && keyword.size() > off + 3 &&
                     keyword.find_first_not_of("0123456789", off + 3) == std::string::npos;
  if (glued) keyword.resize(off + 3);
  std::string_view rest = keyword;
  for (std::size_t before = 0; before != rest.size();) {
    before = rest.size();
    const auto strip = [&](std::string_view prefix, std::int64_t floats) {
      if (!rest.starts_with(prefix)) return;
      rest.remove_prefix(prefix.size());
      header.vertex_bytes += 4 * floats;
    };
    strip("ST", 2);
    strip("C", 4);
    strip("N", 3);
  }
  const std::string_view prefixes = std::string_view(keyword).substr(0, off);
  header.normals = prefixes.find('N') != std::string_view::npos;
  header.colours = prefixes.find('C') != std::string_view::npos;
  header.homogeneous = rest == "4OFF";
  if (header.homogeneous) {
    header.vertex_bytes += 4;
    rest.remove_prefix(1);
  }
  if (rest == "nOFF" || rest == "4nOFF")
    scanner.fail("OFF files with other than three dimensions are not supported",
                 "export the scan in three dimensions");
  if (rest != "OFF")
    scanner.fail("this is not an OFF file: it begins neither with OFF nor with the counts",
                 "correct its extension");
  header.keyword = keyword;
  scanner.take(keyword.size());
  return header;
}

OffHeader read_header(TextScanner& scanner) {
  if (!scanner.skip_to_content())
    scanner.fail("the file holds nothing but comments", "export the scan again");
  OffHeader header = read_keyword(scanner);
  header.binary = scanner.peek() == "BINARY";
  if (header.binary && !scanner.next_line())
    scanner.fail("the file ends after its header", "copy the file again from its source");
  return header;
}

struct Counts {
  std::int64_t vertices = 0;
  std::int64_t faces = 0;
};

/// Adds a vertex. `w` divides its coordinates.
void add_vertex(ScanBuilder& builder, const Eigen::Vector3d& xyz, double w, Place place) {
  const Eigen::Vector3d p = w == 1 ? xyz : Eigen::Vector3d(xyz / w);
  builder.add_point(p.x(), p.y(), p.z(), place);
}

/// Adds the normal of the last vertex. Some writers put colours before normals, so where there are
/// colours, only what has the length of a normal is taken for one.
void add_normal(ScanBuilder& builder, const Eigen::Vector3d& normal, const OffHeader& header) {
  if (header.colours && std::abs(normal.norm() - 1) > 0.01) return;
  builder.add_normal(builder.point_count() - 1, normal.cast<float>());
}

class OffText {
 public:
  OffText(TextScanner& scanner, ScanBuilder& builder, const OffHeader& header)
      : scanner_(scanner), builder_(builder), header_(header) {}

  void read() {
    const Counts counts = read_counts();
    for (std::int64_t i = 0; i < counts.vertices; ++i) {
      begin_line("vertices", counts.vertices, i);
      read_vertex();
      scanner_.next_line();  // passes over normals and colours, which some files do not announce
    }
    for (std::int64_t i = 0; i < counts.faces; ++i) {
      begin_line("faces", counts.faces, i);
      read_face();
      scanner_.next_line();  // passes over the colour
    }
    scanner_.skip_to_content();  // passes over comments at the end
  }

 private:
  Place place() const { return {Place::Unit::kLine, scanner_.line()}; }

  void read_vertex() {
    const Place place = this->place();
    const double x = first_x_ ? *std::exchange(first_x_, {}) : scanner_.number("the x coordinate");
    const double y = next_number("the y coordinate");
    const double z = next_number("the z coordinate");
    const double w = header_.homogeneous ? next_number("the fourth coordinate") : 1;
    add_vertex(builder_, {x, y, z}, w, place);
    if (header_.normals) read_normal();
  }

  /// Reads a normal. If no value follows the coordinates in the first line, values stand on lines
  /// of their own. Otherwise a line that has fewer than three is without a normal.
  void read_normal() {
    if (builder_.point_count() == 1) spread_ = scanner_.at_line_end();
    Eigen::Vector3d normal;
    for (double& component : normal) {
      if (!spread_ && scanner_.at_line_end()) return;
      component = spread_ ? next_number("a normal") : parse_decimal(scanner_.word()).value;
    }
    add_normal(builder_, normal, header_);
  }

  /// Values may stand on lines of their own.
  double next_number(std::string_view what) {
    if (scanner_.at_line_end()) scanner_.skip_to_content();
    return scanner_.number(what);
  }
  std::int64_t next_integer(std::string_view what) {
    if (scanner_.at_line_end()) scanner_.skip_to_content();
    return scanner_.integer(what);
  }

  Counts read_counts() {
    scanner_.skip_to_content();
    const Counts counts{.vertices = scanner_.integer("the number of vertices"),
                        .faces = next_integer("the number of faces")};
    if (counts.vertices < 0 || counts.faces < 0)
      scanner_.fail("the header has a negative count", kMendLine);
    builder_.promise_points(counts.vertices, 5, place());  // "0 0 0"
    builder_.promise_faces(counts.faces, 1, place());      // "0"
    pass_over_edges();
    return counts;
  }

  /// Passes over the number of edges. It may stand on a line of its own, and some writers leave it
  /// out: a line of more values is the first vertex.
  void pass_over_edges() {
    if (scanner_.at_line_end() && scanner_.skip_to_content()) {
      const double value = scanner_.number("the x coordinate");
      if (!scanner_.at_line_end()) {
        first_x_ = value;
        return;
      }
    }
    scanner_.next_line();
  }

  void begin_line(std::string_view what, std::int64_t promised, std::int64_t found) {
    if (!scanner_.skip_to_content()) builder_.fail_promise(what, promised, found, place());
  }

  void read_face() {
    const Place place = this->place();
    const std::int64_t corners = scanner_.integer("the number of corners");
    if (corners < 0) scanner_.fail("a face has a negative number of corners", kMendLine);
    builder_.check_corner_count(corners, place);
    corners_.clear();
    for (std::int64_t i = 0; i < corners; ++i) corners_.push_back(next_integer("a vertex index"));
    builder_.add_face(corners_, place);
  }

  TextScanner& scanner_;
  ScanBuilder& builder_;
  const OffHeader& header_;
  std::optional<double> first_x_;  // of the first vertex, if it was read
  bool spread_ = false;            // values stand on lines of their own
  std::vector<std::int64_t> corners_;
};

/// Reads binary OFF. It has big-endian 32-bit numbers: the three counts, the vertices, and then for
/// each face its corners and the components of its colour, each list after its length.
class OffBinary {
 public:
  OffBinary(ByteSource& source, ScanBuilder& builder, const OffHeader& header)
      : source_(source), builder_(builder), header_(header) {}

  void read() {
    const Counts counts = read_counts();
    begin("vertices", counts.vertices);
    for (; index_ < counts.vertices; ++index_) read_vertex();
    begin("faces", counts.faces);
    for (; index_ < counts.faces; ++index_) read_face();
  }

 private:
  Place place() const { return {Place::Unit::kByte, source_.position()}; }

  void begin(std::string_view what, std::int64_t promised) {
    what_ = what;
    promised_ = promised;
    index_ = 0;
  }

  void read_vertex() {
    const std::int64_t end = source_.position() + header_.vertex_bytes;
    const Place place = this->place();
    Eigen::Vector3d xyz;
    for (double& coordinate : xyz) coordinate = next<float>();
    add_vertex(builder_, xyz, header_.homogeneous ? next<float>() : 1, place);
    if (header_.normals) {
      Eigen::Vector3d normal;
      for (double& component : normal) component = next<float>();
      add_normal(builder_, normal, header_);
    }
    skip(end - source_.position());
  }

  Counts read_counts() {
    const Place place = this->place();
    begin("counts", 3);
    const std::int64_t vertices = next<std::int32_t>();
    const std::int64_t faces = next<std::int32_t>();
    next<std::int32_t>();  // edges
    if (vertices < 0 || faces < 0)
      builder_.fail(place, "the header has a negative count", "export the scan again");
    builder_.promise_points(vertices, header_.vertex_bytes, place);
    builder_.promise_faces(faces, 8, place);
    return {.vertices = vertices, .faces = faces};
  }

  std::int64_t next_length() {
    const Place place = this->place();
    const std::int64_t length = next<std::int32_t>();
    if (length < 0)
      builder_.fail(place, "the length of a list is negative", "export the scan again");
    return length;
  }

  void read_face() {
    const Place place = this->place();
    const std::int64_t corners = next_length();
    builder_.check_corner_count(corners, place);
    corners_.clear();
    for (std::int64_t i = 0; i < corners; ++i) corners_.push_back(next<std::int32_t>());
    builder_.add_face(corners_, place);
    skip(4 * next_length());
  }

  template <typename Number>
  Number next() {
    if (!source_.fill(sizeof(Number))) fail_end();
    const auto number = load<Number>(source_.ahead().data(), std::endian::big);
    source_.consume(sizeof(Number));
    return number;
  }

  void skip(std::int64_t bytes) {
    if (source_.skip(bytes) < bytes) fail_end();
  }

  [[noreturn]] void fail_end() {
    source_.skip(ByteSource::kWindowBytes);  // passes over the rest of a number, to the end
    builder_.fail_promise(what_, promised_, index_, place());
  }

  ByteSource& source_;
  ScanBuilder& builder_;
  const OffHeader& header_;
  std::string_view what_;
  std::int64_t promised_ = 0;
  std::int64_t index_ = 0;
  std::vector<std::int64_t> corners_;
};

Scan read_off(ByteSource& source, const ScanOptions& options) {
  TextScanner scanner(source, {.hash_comments = true});
  ScanBuilder builder(source, options);
  const OffHeader header = read_header(scanner);
  scanner.release();
  if (header.binary) {
    OffBinary(source, builder, header).read();
    return builder.finish(header.keyword + " binary");
  }
  OffText(scanner, builder, header).read();
  return builder.finish(header.keyword);
}

std::string variant_of(std::string_view begin) {
  const std::string_view keyword = begin.substr(0, begin.find('\n'));
  return keyword.find("BINARY") != std::string_view::npos ? "OFF binary" : "OFF";
}

}  // namespace

const ScanFormat kOffFormat = {.extension = ".off",
                               .read = read_off,
                               .variant = variant_of,
                               .content = "meshes",
                               .variants = "text, binary"};

}  // namespace semigeo::io
