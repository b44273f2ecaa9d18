#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <utility>

#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kMostLines = std::int64_t{1} << 20;  // of a grid, in either direction

/// What stands before the points of a cloud.
struct CloudHeader {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  Eigen::Vector3d scanner = Eigen::Vector3d::Zero();    ///< In the common frame.
  Eigen::Matrix4d to_common = Eigen::Matrix4d::Zero();  ///< Its points' way into the common frame.
};

/// Reads clouds, each of which is a grid of the same scanner position.
class PtxText {
 public:
  PtxText(ByteSource& source, ScanBuilder& builder) : scanner_(source), builder_(builder) {}

  void read() {
    do {
      read_cloud();
    } while (scanner_.skip_to_content());
  }

 private:
  Place place() const { return {Place::Unit::kLine, scanner_.line()}; }

  void begin_line(std::string_view what) {
    if (!scanner_.skip_to_content())
      builder_.fail(place(), "the file ends where " + std::string(what) + " should be",
                    "copy the file again from its source");
  }

  std::int64_t read_count(std::string_view what) {
    begin_line(what);
    const std::int64_t count = scanner_.integer(what);
    if (count < 1 || count > kMostLines)
      scanner_.fail(std::string(what) + " is not in 1 ... " + std::to_string(kMostLines),
                    "correct the line or export the scan again");
    end_line(what);
    return count;
  }

  /// Reads a line of numbers into `values`.
  template <typename Values>
  void read_numbers(Values&& values, std::string_view what) {
    begin_line(what);
    for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = scanner_.number(what);
    end_line(what);
  }

  void end_line(std::string_view what) {
    if (!scanner_.at_line_end())
      scanner_.fail("the line has more than " + std::string(what),
                    "correct the line or export the scan again");
    scanner_.next_line();
  }

  CloudHeader read_header() {
    CloudHeader header;
    header.columns = read_count("the number of columns");
    header.rows = read_count("the number of rows");
    read_numbers(header.scanner, "the scanner's position");
    for (int i = 0; i < 3; ++i) {
      Eigen::Vector3d axis;
      read_numbers(axis, "an axis of the scanner");
    }
    // The file multiplies rows from the left: its last row is the translation.
    for (int i = 0; i < 4; ++i) read_numbers(header.to_common.col(i), "a row of the matrix");
    return header;
  }

  void read_cloud() {
    const Place start = place();
    const CloudHeader header = read_header();
    // Some programs leave the scanner's position at zero. It is the origin of the cloud's frame.
    const bool named = header.scanner != Eigen::Vector3d::Zero();
    const Eigen::Vector3d eye = named ? header.scanner : header.to_common.topRightCorner<3, 1>();
    // The points of a column follow one another. The eye, not the order, says which side is seen.
    kernels::RangeGrid grid = {
        .rows = header.columns, .columns = header.rows, .cells = {}, .eye = eye};
    const std::int64_t count = header.columns * header.rows;
    for (std::int64_t i = 0; i < count; ++i) {
      if (!scanner_.skip_to_content()) builder_.fail_promise("points", count, i, place());
      const double x = scanner_.number("the x coordinate");
      const double y = scanner_.number("the y coordinate");
      const double z = scanner_.number("the z coordinate");
      add({x, y, z}, header, grid);
      scanner_.next_line();  // passes over intensity and colour
    }
    builder_.add_grid(std::move(grid), start);
  }

  void add(const Eigen::Vector3d& p, const CloudHeader& header, kernels::RangeGrid& grid) {
    if (p == Eigen::Vector3d::Zero() || !p.allFinite()) {  // nothing was measured
      grid.cells.push_back(-1);
      return;
    }
    grid.cells.push_back(static_cast<std::int32_t>(builder_.point_count()));
    const Eigen::Vector3d moved = (header.to_common * p.homogeneous()).head<3>();
    builder_.add_point(moved.x(), moved.y(), moved.z(), place());
  }

  TextScanner scanner_;
  ScanBuilder& builder_;
};

Scan read_ptx(ByteSource& source, const ScanOptions& options) {
  ScanBuilder builder(source, options);
  PtxText(source, builder).read();
  return builder.finish("PTX");
}

std::string variant_of(std::string_view) {
  return "PTX";
}

}  // namespace

const ScanFormat kPtxFormat = {.extension = ".ptx",
                               .read = read_ptx,
                               .variant = variant_of,
                               .content = "range grids",
                               .variants = ""};

}  // namespace semigeo::io
