#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/files/printable.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"
#include "io/scans/vtk_cells.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kExportAgain = "export the scan again";
constexpr const char* kExtractSurface =
    "save its surface as PolyData (in ParaView: Extract Surface) or as .ply";
constexpr std::int64_t kMostNumbers = std::int64_t{1} << 50;

using Kind = VtkType::Kind;
/// The names of types, in lower case. vtkIdType has 32 bits in these files.
constexpr std::array<std::pair<std::string_view, VtkType>, 23> kTypes = {{
    {"float", {Kind::kFloat, 4}},
    {"double", {Kind::kFloat, 8}},
    {"char", {Kind::kSigned, 1}},
    {"signed_char", {Kind::kSigned, 1}},
    {"unsigned_char", {Kind::kUnsigned, 1}},
    {"short", {Kind::kSigned, 2}},
    {"unsigned_short", {Kind::kUnsigned, 2}},
    {"int", {Kind::kSigned, 4}},
    {"unsigned_int", {Kind::kUnsigned, 4}},
    {"long", {Kind::kSigned, 8}},
    {"unsigned_long", {Kind::kUnsigned, 8}},
    {"long_long", {Kind::kSigned, 8}},
    {"unsigned_long_long", {Kind::kUnsigned, 8}},
    {"vtkidtype", {Kind::kSigned, 4}},
    {"vtktypeint64", {Kind::kSigned, 8}},
    {"vtktypeuint64", {Kind::kUnsigned, 8}},
    {"vtktypeint32", {Kind::kSigned, 4}},
    {"vtktypeuint32", {Kind::kUnsigned, 4}},
    {"vtktypeint16", {Kind::kSigned, 2}},
    {"vtktypeuint16", {Kind::kUnsigned, 2}},
    {"vtktypeint8", {Kind::kSigned, 1}},
    {"vtktypeuint8", {Kind::kUnsigned, 1}},
    {"vtktypefloat64", {Kind::kFloat, 8}},
}};

/// The types of cells of an unstructured grid.
enum CellType : std::int64_t {
  kEmpty = 0,
  kVertex = 1,
  kPolyVertex = 2,
  kLine = 3,
  kPolyLine = 4,
  kTriangle = 5,
  kStrip = 6,
  kPolygon = 7,
  kPixel = 8,
  kQuad = 9
};

/// Reads a file of the older, "legacy" format. Its header and keywords are text; its numbers are
/// text or big-endian.
class VtkReader {
 public:
  VtkReader(ByteSource& source, ScanBuilder& builder) : source_(source), builder_(builder) {
    scanner_.emplace(source_);
  }

  bool binary() const { return binary_; }

  void read() {
    read_header();
    bool more = true;
    while (more && scanner_->skip_to_content()) more = read_section();
    if (cells_.count() != std::ssize(cell_types_))
      builder_.fail(place(),
                    "there are " + std::to_string(cells_.count()) + " cells, but " +
                        std::to_string(cell_types_.size()) + " types of cells",
                    kExportAgain);
    for (std::int64_t i = 0; i < cells_.count(); ++i) add_cell(i);
  }

 private:
  void read_header() {
    std::string first;
    for (int i = 0; i < 3; ++i) first += lower_case(scanner_->word());
    if (first != "#vtkdatafile")
      scanner_->fail("this is not a VTK file: it does not begin with '# vtk DataFile Version'",
                     "correct its extension");
    const std::string version(scanner_->word() == "Version" ? scanner_->word() : "");
    version_ = version.empty() ? 0 : version[0] - '0';
    scanner_->next_line();
    scanner_->next_line();  // passes over the title, which may be empty
    scanner_->skip_to_content();
    const std::string encoding = lower_case(scanner_->word());
    binary_ = encoding == "binary";
    if (!binary_ && encoding != "ascii")
      scanner_->fail("the line is neither ASCII nor BINARY", kExportAgain);
    scanner_->next_line();
  }

  /// Reads what a keyword announces. Returns false if nothing behind it is part of the surface.
  bool read_section() {
    const std::string keyword = lower_case(scanner_->word());
    if (keyword == "dataset") {
      read_dataset();
    } else if (keyword == "points") {
      read_points();
    } else if (keyword == "polygons") {
      const VtkCells cells = read_cells();
      for (std::int64_t i = 0; i < cells.count(); ++i)
        add_vtk_polygon(builder_, cells.cell(i), faces_++);
    } else if (keyword == "triangle_strips") {
      const VtkCells cells = read_cells();
      for (std::int64_t i = 0; i < cells.count(); ++i)
        add_vtk_strip(builder_, cells.cell(i), faces_++);
    } else if (keyword == "vertices" || keyword == "lines") {
      const VtkCells cells = read_cells();
      for (std::int64_t i = 0; i < cells.count(); ++i)
        add_vtk_part(builder_, cells.cell(i), faces_++);
    } else if (keyword == "cells") {
      cells_ = read_cells();
    } else if (keyword == "cell_types") {
      cell_types_ = read_numbers(count("the number of cells"), {Kind::kSigned, 4}, "cell types");
    } else if (keyword == "metadata") {
      skip_metadata();
    } else if (keyword == "field") {
      skip_field();
    } else if (keyword == "point_data" || keyword == "cell_data") {
      read_data(keyword);
      scanner_->release();
      source_.skip(std::numeric_limits<std::int64_t>::max());
      return false;
    } else {
      scanner_->fail("the line does not begin with a keyword of VTK: '" +
                         printable(keyword.substr(0, 40)) + "'",
                     kExportAgain);
    }
    return true;
  }

  void read_dataset() {
    const std::string kind = lower_case(scanner_->word());
    if (kind != "polydata" && kind != "unstructured_grid")
      scanner_->fail(
          "a data set of the kind '" + printable(kind.substr(0, 40)) + "' is not a surface",
          kExtractSurface);
    scanner_->next_line();
  }

  std::int64_t count(std::string_view what) {
    const std::int64_t number = scanner_->integer(what);
    if (number < 0 || number > kMostNumbers)
      scanner_->fail(std::string(what) + " is negative or too large", kExportAgain);
    return number;
  }

  /// Returns nothing for a type that is unknown.
  static std::optional<VtkType> find_type(std::string_view name) {
    const auto* const known =
        std::ranges::find(kTypes, name, &std::pair<std::string_view, VtkType>::first);
    return known == kTypes.end() ? std::nullopt : std::optional(known->second);
  }

  VtkType read_type() {
    const std::string name = lower_case(scanner_->word());
    const std::optional<VtkType> type = find_type(name);
    if (!type)
      scanner_->fail("the type of numbers '" + printable(name.substr(0, 40)) + "' is not supported",
                     kExportAgain);
    return *type;
  }

  Place place() const {
    return binary_ ? Place{Place::Unit::kByte, source_.position()}
                   : Place{Place::Unit::kLine, scanner_->line()};
  }

  /// Calls `use` with each of the numbers from here on, which in a binary file begin right here.
  template <typename Number, typename Use>
  void for_each_number(std::int64_t count, VtkType type, std::string_view what, Use use) {
    if (!binary_) {
      for (std::int64_t i = 0; i < count; ++i) {
        if (scanner_->at_line_end() && !scanner_->skip_to_content())
          builder_.fail_promise(what, count, i, place());
        use(i, std::is_same_v<Number, double> ? static_cast<Number>(scanner_->number("a number"))
                                              : static_cast<Number>(scanner_->integer("an index")));
      }
      return;
    }
    scanner_->release();
    for (std::int64_t i = 0; i < count; ++i) {
      if (!source_.fill(type.bytes)) builder_.fail_promise(what, count, i, place());
      const auto number = type.load_from<Number>(source_.ahead().data(), std::endian::big);
      use(i, number);
      source_.consume(type.bytes);
    }
    scanner_.emplace(source_, TextSyntax{}, scanner_->line());
  }

  std::vector<std::int64_t> read_numbers(std::int64_t count, VtkType type, std::string_view what) {
    if (type.kind == Kind::kFloat)
      scanner_->fail("the indices are not whole numbers", kExportAgain);
    std::vector<std::int64_t> numbers;
    scanner_->next_line();
    for_each_number<std::int64_t>(
        count, type, what, [&](std::int64_t, std::int64_t number) { numbers.push_back(number); });
    return numbers;
  }

  void read_points() {
    const std::int64_t points = count("the number of points");
    if (builder_.point_count() > 0)
      scanner_->fail("the file has a second list of points", kExportAgain);
    const VtkType type = read_type();
    builder_.promise_points(points, binary_ ? 3 * type.bytes : 6, place());  // "0 0 0 "
    scanner_->next_line();
    std::array<double, 3> xyz{};
    for_each_number<double>(3 * points, type, "coordinates", [&](std::int64_t i, double number) {
      xyz[i % 3] = number;
      if (i % 3 == 2) builder_.add_point(xyz[0], xyz[1], xyz[2], place());
    });
  }

  /// Reads a list of cells in either layout: each cell behind its number of corners or, since
  /// version 5.1, all offsets and then all corners.
  VtkCells read_cells() {
    const std::int64_t first = count("the number of cells");
    const std::int64_t second = count("the number of corners");
    const Place begin = place();
    if (!scanner_->next_line()) builder_.fail_promise("cells", first, 0, place());
    if (version_ >= 5) {
      scanner_->skip_to_content();
      if (lower_case(scanner_->peek()) == "offsets") return read_offsets(first, second);
      if (binary_) scanner_->fail("there are no OFFSETS behind the counts", kExportAgain);
    }
    return read_counted_cells(first, second, begin);
  }

  VtkCells read_offsets(std::int64_t offsets, std::int64_t corners) {
    VtkCells cells;
    scanner_->word();
    cells.ends = read_numbers(offsets, read_type(), "offsets");
    if (!scanner_->skip_to_content() || lower_case(scanner_->word()) != "connectivity")
      scanner_->fail("there is no CONNECTIVITY behind the offsets", kExportAgain);
    const Place begin = place();
    cells.corners = read_numbers(corners, read_type(), "corners");
    if (cells.ends.empty()) return cells;
    const std::int64_t first = cells.ends.front();
    cells.ends.erase(cells.ends.begin());
    if (first != 0 || cells.first_bad_cell() >= 0)
      builder_.fail(begin, "the offsets of the cells do not fit their corners", kExportAgain);
    return cells;
  }

  /// Reads cells that stand behind their numbers of corners. The current line is the first of them.
  VtkCells read_counted_cells(std::int64_t count, std::int64_t numbers, Place begin) {
    VtkCells cells;
    std::int64_t left = 0;
    for_each_number<std::int64_t>(
        numbers, {Kind::kSigned, 4}, "numbers of cells", [&](std::int64_t, std::int64_t number) {
          if (left > 0) {
            cells.corners.push_back(number);
            --left;
          } else {
            if (number < 0 || number > numbers)
              builder_.fail(place(), "the number of corners of a cell is out of range",
                            kExportAgain);
            left = number;
            cells.ends.push_back(static_cast<std::int64_t>(cells.corners.size()) + left);
          }
        });
    if (left > 0 || cells.count() != count)
      builder_.fail(begin, "the counts of the cells do not fit their corners", kExportAgain);
    return cells;
  }

  /// Reads normals from the data of points and cells, of which the keyword tells one. Normals only
  /// help: behind what cannot be read, there are none.
  void read_data(std::string keyword) try {
    bool of_points = false;
    std::int64_t tuples = 0;
    do {
      if (keyword == "point_data" || keyword == "cell_data") {
        of_points = keyword == "point_data";
        tuples = count("the number of tuples");
        scanner_->next_line();
      } else {
        read_attribute(keyword, tuples, of_points);
      }
      if (!scanner_->skip_to_content()) return;
      keyword = lower_case(scanner_->word());
    } while (!keyword.empty());
  } catch (const ReadError&) {
    throw;
  } catch (const Error&) {
  }

  /// Reads an array of the data: normals of points, or anything else, which is passed over.
  void read_attribute(const std::string& keyword, std::int64_t tuples, bool of_points) {
    if (keyword == "field") return skip_field();
    if (keyword == "metadata") return skip_metadata();
    scanner_->word();  // its name
    if (keyword == "normals" && of_points) return read_normals(tuples);
    if (keyword == "lookup_table")
      return skip_values(4 * count("the number of colours"), {Kind::kUnsigned, 1});
    if (keyword == "color_scalars")
      return skip_values(product(count("the number of components"), tuples), {Kind::kUnsigned, 1});
    const std::int64_t first = keyword == "texture_coordinates" ? count("the dimension") : 0;
    const VtkType type = read_type();
    if (keyword != "scalars")
      return skip_values(product(components_of(keyword, first), tuples), type);
    const std::int64_t components = scanner_->at_line_end() ? 1 : count("the number of components");
    scanner_->next_line();
    if (lower_case(scanner_->peek()) != "lookup_table")
      scanner_->fail("there is no LOOKUP_TABLE behind the scalars", kExportAgain);
    scanner_->word();
    scanner_->word();  // the name of the table
    skip_values(product(components, tuples), type);
  }

  /// Returns how many numbers a tuple of an array has.
  std::int64_t components_of(const std::string& keyword, std::int64_t dimension) const {
    if (keyword == "vectors" || keyword == "normals") return 3;
    if (keyword == "tensors") return 9;
    if (keyword == "tensors6") return 6;
    if (keyword == "texture_coordinates") return dimension;
    if (keyword == "global_ids" || keyword == "pedigree_ids") return 1;
    scanner_->fail("the data is of an unknown kind", kExportAgain);
  }

  void read_normals(std::int64_t tuples) {
    const VtkType type = read_type();
    scanner_->next_line();
    Eigen::Vector3f normal;
    for_each_number<double>(3 * tuples, type, "normals", [&](std::int64_t i, double number) {
      normal[i % 3] = static_cast<float>(number);
      if (i % 3 == 2) builder_.add_normal(i / 3, normal);
    });
  }

  void skip_metadata() {
    while (scanner_->next_line() && !scanner_->at_line_end()) {
    }
  }

  /// Passes over numbers that begin in the next line.
  void skip_values(std::int64_t values, VtkType type) {
    if (binary_) {
      scanner_->next_line();
      return skip_bytes(type.bytes * values);
    }
    for (std::int64_t i = 0; i < values; ++i) {
      if (scanner_->at_line_end() && !scanner_->skip_to_content())
        builder_.fail_promise("values of an array", values, i, place());
      scanner_->word();
    }
  }

  /// Passes over arrays that have names of their own.
  void skip_field() {
    scanner_->word();
    const std::int64_t arrays = count("the number of arrays");
    for (std::int64_t i = 0; i < arrays; ++i) {
      scanner_->next_line();
      if (!scanner_->skip_to_content()) builder_.fail_promise("arrays", arrays, i, place());
      scanner_->word();
      const std::int64_t components = count("the number of components");
      const std::int64_t tuples = count("the number of tuples");
      skip_array(product(components, tuples));
    }
  }

  std::int64_t product(std::int64_t components, std::int64_t tuples) const {
    if (components > 0 && tuples > kMostNumbers / components)
      scanner_->fail("the array is too large", kExportAgain);
    return components * tuples;
  }

  void skip_array(std::int64_t values) {
    const std::string name = lower_case(scanner_->peek());
    if (name == "string" && !binary_) {
      for (std::int64_t i = 0; i < values && scanner_->next_line(); ++i) {
      }
      while (!scanner_->at_line_end()) scanner_->word();
      return;
    }
    skip_values(values, read_type());
  }

  void skip_bytes(std::int64_t bytes) {
    scanner_->release();
    const std::int64_t line = scanner_->line();
    const std::int64_t skipped = source_.skip(bytes);
    if (skipped < bytes) builder_.fail_promise("bytes of an array", bytes, skipped, place());
    scanner_.emplace(source_, TextSyntax{}, line);
  }

  /// Adds a cell of the unstructured grid.
  void add_cell(std::int64_t i) {
    const std::span<const std::int64_t> corners = cells_.cell(i);
    const auto fits = [&](std::size_t count) {
      if (corners.size() != count)
        builder_.fail({Place::Unit::kFace, i},
                      "the cell has " + std::to_string(corners.size()) + " corners, not " +
                          std::to_string(count),
                      kExportAgain);
    };
    switch (cell_types_[i]) {
      case kEmpty:
      case kVertex:
      case kPolyVertex:
      case kLine:
      case kPolyLine:
        return add_vtk_part(builder_, corners, i);
      case kStrip:
        return add_vtk_strip(builder_, corners, i);
      case kPixel:
        fits(4);
        return add_vtk_polygon(builder_, std::array{corners[0], corners[1], corners[3], corners[2]},
                               i);
      case kTriangle:
      case kQuad:
        fits(cell_types_[i] == kTriangle ? 3 : 4);
        [[fallthrough]];
      case kPolygon:
        return add_vtk_polygon(builder_, corners, i);
      default:
        builder_.fail({Place::Unit::kFace, i},
                      "the cell is of type " + std::to_string(cell_types_[i]) +
                          ", which is neither a flat polygon nor a strip",
                      kExtractSurface);
    }
  }

  ByteSource& source_;
  ScanBuilder& builder_;
  std::optional<TextScanner> scanner_;
  bool binary_ = false;
  int version_ = 0;  // the first number of the file's version
  std::int64_t faces_ = 0;
  VtkCells cells_;  // of an unstructured grid
  std::vector<std::int64_t> cell_types_;
};

Scan read_vtk(ByteSource& source, const ScanOptions& options) {
  ScanBuilder builder(source, options);
  VtkReader reader(source, builder);
  reader.read();
  return builder.finish(reader.binary() ? "VTK binary" : "VTK ascii");
}

std::string variant_of(std::string_view begin) {
  return begin.find("\nBINARY") != std::string_view::npos ? "VTK binary" : "VTK ascii";
}

}  // namespace

const ScanFormat kVtkFormat = {.extension = ".vtk",
                               .read = read_vtk,
                               .variant = variant_of,
                               .content = "meshes, triangle strips",
                               .variants = "legacy VTK, ascii or binary, of version 5.1 or older"};

}  // namespace semigeo::io
