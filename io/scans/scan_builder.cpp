#include "io/scans/scan_builder.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

constexpr std::int64_t kMaxIndexable = std::numeric_limits<std::int32_t>::max() - 1;
constexpr const char* kExportAgain = "copy the file again from its source or export it again";

}  // namespace

ScanBuilder::ScanBuilder(const ByteSource& source, const ScanOptions& options)
    : source_(source), options_(options) {
  options_.max_vertices = std::min(options_.max_vertices, kMaxIndexable);
  index_limit_ = options_.max_vertices;
}

void ScanBuilder::promise_points(std::int64_t count, std::int64_t bytes_each, Place place) {
  index_limit_ = count;
  index_limit_known_ = true;
  const std::optional<std::int64_t> left = source_.bytes_left();
  const bool possible = !left || count <= *left / bytes_each;
  if (possible && count > options_.max_vertices)
    fail_limit("vertices", options_.max_vertices, place);
  if (left && possible) scan_.mesh.points.reserve(static_cast<std::size_t>(count));
}

void ScanBuilder::promise_faces(std::int64_t count, std::int64_t bytes_each, Place place) {
  const std::optional<std::int64_t> left = source_.bytes_left();
  const bool possible = !left || count <= *left / bytes_each;
  if (possible && count > options_.max_triangles)
    fail_limit("triangles", options_.max_triangles, place);
  if (left && possible) scan_.mesh.triangles.reserve(static_cast<std::size_t>(count));
}

void ScanBuilder::add_face(std::span<const std::int64_t> corners, Place place) {
  for (const std::int64_t corner : corners) check_corner(corner, place);
  if (corners.size() < 3) {
    ++scan_.faces_skipped;
    return;
  }
  const auto count = static_cast<std::int64_t>(corners.size());
  triangle_count_ += count - 2;
  if (triangle_count_ > options_.max_triangles)
    fail_limit("triangles", options_.max_triangles, place);
  if (count == 3) {
    scan_.mesh.triangles.push_back({static_cast<std::int32_t>(corners[0]),
                                    static_cast<std::int32_t>(corners[1]),
                                    static_cast<std::int32_t>(corners[2])});
    return;
  }
  ++scan_.polygons_triangulated;
  if (*std::max_element(corners.begin(), corners.end()) < point_count()) {
    add_polygon(corners);
  } else {
    waiting_.push_back(static_cast<std::int32_t>(count));
    for (const std::int64_t corner : corners) waiting_.push_back(static_cast<std::int32_t>(corner));
  }
}

void ScanBuilder::add_polygon(std::span<const std::int64_t> corners) {
  polygon_.clear();
  for (const std::int64_t corner : corners) polygon_.push_back(scan_.mesh.points[corner]);
  for (const auto& [a, b, c] : triangulator_.triangulate(polygon_))
    scan_.mesh.triangles.push_back({static_cast<std::int32_t>(corners[a]),
                                    static_cast<std::int32_t>(corners[b]),
                                    static_cast<std::int32_t>(corners[c])});
}

void ScanBuilder::add_bad_point(double x, double y, double z, Place place) {
  const std::int64_t index = point_count();
  if (!first_bad_point_) first_bad_point_ = {index, x, y, z, place};
  bad_points_.push_back(index);
  add_point(0, 0, 0, place);
}

std::vector<bool> ScanBuilder::bad_points() const {
  std::vector<bool> bad(scan_.mesh.points.size(), false);
  for (const std::int64_t v : bad_points_) bad[v] = true;
  return bad;
}

void ScanBuilder::add_grid(kernels::RangeGrid grid, Place place) {
  if (!bad_points_.empty()) {
    const std::vector<bool> bad = bad_points();
    for (std::int32_t& cell : grid.cells)
      if (cell >= 0 && bad[cell]) cell = -1;
  }
  const kernels::GridTriangles made =
      kernels::triangulate_grid(grid, scan_.mesh.points, options_.depth_jump);
  triangle_count_ += std::ssize(made.triangles);
  if (triangle_count_ > options_.max_triangles)
    fail_limit("triangles", options_.max_triangles, place);
  scan_.mesh.triangles.insert(scan_.mesh.triangles.end(), made.triangles.begin(),
                              made.triangles.end());
  scan_.depth_jump_triangles += made.jumps;
  scan_.eye = ++grid_count_ == 1 ? grid.eye : std::nullopt;
}

void ScanBuilder::drop_bad_points() {
  const std::vector<bool> bad = bad_points();
  scan_.bad_vertices = std::ssize(bad_points_);
  scan_.faces_of_bad_vertices = static_cast<std::int64_t>(std::erase_if(
      scan_.mesh.triangles, [&](const auto& t) { return bad[t[0]] || bad[t[1]] || bad[t[2]]; }));
  if (scan_.mesh.triangles.empty()) fail_coordinate(*first_bad_point_);
}

Scan ScanBuilder::finish(std::string format) {
  if (point_count() == 0)
    throw Error(source_.path(), "", "it holds no vertices", "export a scan with a surface");
  if (largest_ahead_ >= point_count()) {
    index_limit_ = point_count();
    index_limit_known_ = true;
    fail_index(largest_ahead_, largest_ahead_place_);
  }
  if (triangle_count_ == 0) fail_without_faces();
  if (!scan_.mesh.normals.empty())
    scan_.mesh.normals.resize(scan_.mesh.points.size(), Eigen::Vector3f::Zero());
  std::vector<std::int64_t> corners;
  for (std::size_t i = 0; i < waiting_.size(); i += corners.size() + 1) {
    const auto first = waiting_.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    corners.assign(first, first + waiting_[i]);
    add_polygon(corners);
  }
  waiting_ = {};
  if (!bad_points_.empty()) drop_bad_points();
  scan_.format = std::move(format);
  return std::move(scan_);
}

void ScanBuilder::fail(Place place, const std::string& problem, const std::string& remedy) const {
  throw Error(source_.path(), place.text(source_), problem, remedy);
}

void ScanBuilder::fail_promise(std::string_view what, std::int64_t promised, std::int64_t found,
                               Place end, std::string_view hint) const {
  fail(end,
       "the header promises " + std::to_string(promised) + " " + std::string(what) +
           ", but the file ends after " + std::to_string(found) + std::string(hint),
       kExportAgain);
}

void ScanBuilder::fail_coordinate(const BadPoint& point) const {
  for (const auto& [name, value] : {std::pair{"x", point.x}, {"y", point.y}, {"z", point.z}})
    if (!std::isfinite(value))
      fail(point.place, std::string("the ") + name + " coordinate is not a finite number",
           "remove or repair this vertex");
  for (const auto& [name, value] : {std::pair{"x", point.x}, {"y", point.y}, {"z", point.z}})
    if (std::abs(value) > options_.max_coordinate)
      fail(point.place, std::string("the ") + name + " coordinate is implausibly large",
           kExportAgain);
  fail(point.place, "a coordinate is out of range", kExportAgain);
}

void ScanBuilder::fail_corner_count(Place place) const {
  fail(place, "a face has more than " + std::to_string(kMaxCorners) + " corners", kExportAgain);
}

void ScanBuilder::fail_index(std::int64_t corner, Place place) const {
  const std::string face = "a face refers to vertex " + std::to_string(corner + index_base_);
  const std::string limit = std::to_string(index_limit_) + " vertices";
  if (index_limit_known_)
    fail(place,
         face + ", but there are only " + limit + ", numbered from " + std::to_string(index_base_),
         kExportAgain);
  fail(place, face + ", more than the limit of " + limit, kExportAgain);
}

void ScanBuilder::fail_limit(std::string_view what, std::int64_t limit, Place place) const {
  fail(place, "the scan has more than " + std::to_string(limit) + " " + std::string(what),
       "cut it into parts or reduce it first");
}

void ScanBuilder::fail_without_faces() const {
  const std::string points = "it has " + std::to_string(point_count()) + " points but ";
  if (grid_count_ > 0)
    throw Error(source_.path(), "",
                points + "no three of them are neighbours in its grid at about the same depth",
                "export the scan again");
  if (scan_.faces_skipped > 0)
    throw Error(
        source_.path(), "",
        points + "none of its " + std::to_string(scan_.faces_skipped) + " faces has three corners",
        "export it with triangles");
  throw Error(source_.path(), "", points + "no faces", kNeedsSurface);
}

}  // namespace semigeo::io
