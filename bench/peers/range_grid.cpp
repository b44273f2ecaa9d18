#include "bench/peers/range_grid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "bench/support/quantile.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/error.hpp"
#include "io/scans/decimal.hpp"
#include "io/scans/ply_header.hpp"
#include "io/scans/text_scanner.hpp"

namespace semigeo::peers {
namespace {

/// Headers are far shorter.
constexpr std::size_t kHeaderBytes = 1 << 16;
/// The largest number of rows or columns, and of points.
constexpr std::int64_t kMostRays = 1 << 14;

/// Returns the number behind `obj_info name` in a header, or 0.
std::int64_t header_number(std::string_view header, const std::string& name) {
  const std::string key = "obj_info " + name + " ";
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return 0;
  return static_cast<std::int64_t>(io::parse_decimal(header.substr(at + key.size())).value);
}

/// Returns whether the header declares points first and then the grid.
bool describes_grid(const io::PlyHeader& header, const RangeGrid& grid) {
  return header.encoding == io::PlyHeader::Encoding::kAscii && header.elements.size() == 2 &&
         header.elements[0].name == "vertex" && header.elements[0].properties.size() >= 3 &&
         header.elements[0].count <= kMostRays * kMostRays &&
         header.elements[1].name == "range_grid" && grid.rows > 0 && grid.rows <= kMostRays &&
         grid.columns > 0 && grid.columns <= kMostRays &&
         header.elements[1].count == grid.rows * grid.columns;
}

/// Goes to the next line that is not empty.
void next_record(io::TextScanner& text) {
  if (!text.skip_to_content()) text.fail("the file ends before the grid does");
}

/// Collects the triangles of a grid.
class GridTriangles {
 public:
  GridTriangles(const RangeGrid& grid, double longest) : grid_(grid), longest_(longest) {}

  /// Adds the triangles between four neighbouring rays, given in order round their cell.
  void add_cell(const std::array<std::int32_t, 4>& corner) {
    const auto missing = std::ranges::count(corner, -1);
    if (missing > 1) return;
    if (missing == 1) {
      const auto gap = std::ranges::find(corner, -1) - corner.begin();
      add(corner[(gap + 1) % 4], corner[(gap + 2) % 4], corner[(gap + 3) % 4]);
    } else if (length(corner[0], corner[2]) <= length(corner[1], corner[3])) {
      add(corner[0], corner[1], corner[2]);
      add(corner[0], corner[2], corner[3]);
    } else {
      add(corner[0], corner[1], corner[3]);
      add(corner[1], corner[2], corner[3]);
    }
  }

  /// Returns the triangles, turned towards +z.
  std::vector<std::array<std::int32_t, 3>> facing_up() && {
    double up = 0;
    for (const auto& t : triangles_) {
      const Eigen::Vector3d& p = grid_.points[t[0]];
      up += (grid_.points[t[1]] - p).cross(grid_.points[t[2]] - p).z();
    }
    if (up < 0)
      for (auto& t : triangles_) std::swap(t[1], t[2]);
    return std::move(triangles_);
  }

 private:
  double length(std::int32_t a, std::int32_t b) const {
    return (grid_.points[a] - grid_.points[b]).norm();
  }
  void add(std::int32_t a, std::int32_t b, std::int32_t c) {
    if (std::max({length(a, b), length(b, c), length(c, a)}) <= longest_)
      triangles_.push_back({a, b, c});
  }

  const RangeGrid& grid_;
  double longest_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
};

/// Returns the median distance of neighbours in rows and columns.
double median_spacing(const RangeGrid& grid) {
  std::vector<double> lengths;
  const auto measure = [&](std::int32_t a, std::int32_t b) {
    if (a >= 0 && b >= 0) lengths.push_back((grid.points[a] - grid.points[b]).norm());
  };
  for (std::int64_t r = 0; r < grid.rows; ++r)
    for (std::int64_t c = 0; c < grid.columns; ++c) {
      const std::int64_t at = r * grid.columns + c;
      if (c + 1 < grid.columns) measure(grid.cells[at], grid.cells[at + 1]);
      if (r + 1 < grid.rows) measure(grid.cells[at], grid.cells[at + grid.columns]);
    }
  return bench::median(lengths);
}

}  // namespace

RangeGrid read_range_grid(const std::filesystem::path& path) {
  io::ByteSource source(path);
  source.fill(kHeaderBytes);
  std::string_view ahead = source.ahead();
  ahead = ahead.substr(0, ahead.find("end_header"));
  RangeGrid grid{header_number(ahead, "num_rows"), header_number(ahead, "num_cols"), {}, {}};
  const io::PlyHeader header = io::read_ply_header(source);
  if (!describes_grid(header, grid))
    throw io::Error(path, "", "is no ascii PLY of points and a range_grid");
  io::TextScanner text(source, {}, header.lines + 1);
  for (std::int64_t i = 0; i < header.elements[0].count; ++i) {
    next_record(text);
    const double x = text.number("an x coordinate"), y = text.number("a y coordinate");
    grid.points.emplace_back(x, y, text.number("a z coordinate"));
    text.next_line();
  }
  for (std::int64_t i = 0; i < header.elements[1].count; ++i) {
    next_record(text);
    const std::int64_t count = text.integer("a number of points");
    const std::int64_t point = count > 0 ? text.integer("the index of a point") : -1;
    if (count < 0 || count > 1 || point >= header.elements[0].count || (count > 0 && point < 0))
      text.fail("a ray of the grid meets no point or one point of the file");
    grid.cells.push_back(static_cast<std::int32_t>(point));
    text.next_line();
  }
  return grid;
}

kernels::TriangleMesh triangulated(const RangeGrid& grid, double longest) {
  GridTriangles triangles(grid, longest * median_spacing(grid));
  for (std::int64_t r = 0; r + 1 < grid.rows; ++r)
    for (std::int64_t c = 0; c + 1 < grid.columns; ++c) {
      const std::int32_t* const here = &grid.cells[r * grid.columns + c];
      triangles.add_cell({here[0], here[1], here[grid.columns + 1], here[grid.columns]});
    }
  return {grid.points, std::move(triangles).facing_up()};
}

}  // namespace semigeo::peers
