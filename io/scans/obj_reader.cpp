#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <vector>

#include "io/scans/decimal.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kMendLine = "correct the line or export the scan again";

bool is_keyword(std::string_view word) {
  return std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Tells whether a name or path follows the keyword, to the end of the line.
bool precedes_name(std::string_view keyword) {
  constexpr std::array<std::string_view, 8> keywords = {
      "o", "g", "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj"};
  return std::find(keywords.begin(), keywords.end(), keyword) != keywords.end();
}

class ObjBody {
 public:
  ObjBody(ByteSource& source, ScanBuilder& builder)
      : scanner_(source, {.hash_comments = true, .backslash_continues = true}), builder_(builder) {}

  void read() {
    while (scanner_.skip_to_content()) {
      const std::string_view keyword = scanner_.word();
      bool name = false;
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "vn") {
        read_normal();
      } else if (keyword == "f") {
        read_face();
      } else if (is_keyword(keyword)) {
        name = precedes_name(keyword);
      } else {
        scanner_.fail("the line does not begin with a keyword of OBJ (v, f, ...)", kMendLine);
      }
      if (!(name ? scanner_.next_line_after_name() : scanner_.next_line())) break;
    }
  }

 private:
  Place place() const { return {Place::Unit::kLine, scanner_.line()}; }

  void read_vertex() {
    const Place place = this->place();
    const double x = scanner_.number("the x coordinate");
    const double y = scanner_.number("the y coordinate");
    const double z = scanner_.number("the z coordinate");
    builder_.add_point(x, y, z, place);
  }

  /// Reads a normal. One that is no three numbers counts as none.
  void read_normal() {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    for (int axis = 0; axis < 3; ++axis)
      normal[axis] = static_cast<float>(parse_decimal(scanner_.word()).value);
    normals_.push_back(normal);
  }

  void read_face() {
    const Place place = this->place();
    corners_.clear();
    corner_normals_.clear();
    while (!scanner_.at_line_end()) {
      builder_.check_corner_count(static_cast<std::int64_t>(corners_.size()) + 1, place);
      corners_.push_back(read_corner());
    }
    builder_.add_face(corners_, place);
    for (std::size_t k = 0; k < corner_normals_.size(); ++k)
      if (corner_normals_[k] >= 0 && corner_normals_[k] < std::ssize(normals_))
        builder_.add_normal(corners_[k], normals_[static_cast<std::size_t>(corner_normals_[k])]);
  }

  /// Reads a corner: v, v/vt, v//vn or v/vt/vn. Returns v, counted from 0, and notes vn, if any.
  /// Negative numbers count back from the last vertex above the line.
  std::int64_t read_corner() {
    const std::string_view word = scanner_.word();
    const char* const end = word.data() + word.size();
    std::int64_t index = 0;
    const auto [stop, status] = std::from_chars(word.data(), end, index);
    if (status != std::errc{} || (stop != end && *stop != '/'))
      scanner_.fail("a face has a corner that is not v, v/vt, v//vn or v/vt/vn", kMendLine);
    if (!normals_.empty()) note_normal(stop, end);
    if (index > 0) return index - 1;
    if (index == 0) scanner_.fail("a face refers to vertex 0, but OBJ counts from 1", kMendLine);
    if (index < -builder_.point_count())
      scanner_.fail("a face refers to vertex " + std::to_string(index) + ", but only " +
                        std::to_string(builder_.point_count()) + " vertices stand above it",
                    kMendLine);
    return builder_.point_count() + index;
  }

  /// Notes the normal of a corner, counted from 0, of what stands behind its v; -1 for none.
  void note_normal(const char* at, const char* end) {
    std::int64_t index = 0;
    at = std::find(at, end, '/');
    if (at != end) at = std::find(at + 1, end, '/');
    if (at != end) std::from_chars(at + 1, end, index);
    corner_normals_.push_back(index < 0 ? std::ssize(normals_) + index : index - 1);
  }

  TextScanner scanner_;
  ScanBuilder& builder_;
  std::vector<std::int64_t> corners_;
  std::vector<std::int64_t> corner_normals_;  ///< As long as `corners_`, or empty.
  std::vector<Eigen::Vector3f> normals_;
};

Scan read_obj(ByteSource& source, const ScanOptions& options) {
  ScanBuilder builder(source, options);
  builder.set_index_base(1);
  ObjBody(source, builder).read();
  return builder.finish("OBJ");
}

std::string variant_of(std::string_view) {
  return "OBJ";
}

}  // namespace

const ScanFormat kObjFormat = {.extension = ".obj",
                               .read = read_obj,
                               .variant = variant_of,
                               .content = "meshes",
                               .variants = ""};

}  // namespace semigeo::io
