#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_source.hpp"
#include "io/scans/place.hpp"
#include "io/scans/polygon_triangulator.hpp"
#include "io/scans/scan_reader.hpp"
#include "kernels/repair/range_grid.hpp"

namespace semigeo::io {

/// Collects what a reader finds into a `Scan`: checks every coordinate and index, cuts polygons
/// into triangles as soon as their corners are known, and enforces the limits. All its errors name
/// the source and the place that was passed in.
class ScanBuilder {
 public:
  /// Says what can be done about a file that holds points only.
  static constexpr const char* kNeedsSurface =
      "semigeo needs a surface: export it as the scanner's grid (an organised PCD, a PTX, a PLY "
      "with "
      "range_grid), or mesh it first (for example by Poisson reconstruction)";
  /// The largest number of corners that a face may have.
  static constexpr std::int64_t kMaxCorners = 65'535;

  ScanBuilder(const ByteSource& source, const ScanOptions& options);

  /// Sets what counts in messages as the first vertex: 1 for OBJ, otherwise 0.
  void set_index_base(std::int64_t base) { index_base_ = base; }
  /// Takes the promise of a header: this number of vertices, each at least `bytes_each` long. They
  /// are the range of valid indices from now on, and memory is reserved if the file can hold them.
  void promise_points(std::int64_t count, std::int64_t bytes_each, Place place);
  /// Takes the promise of a header about faces.
  void promise_faces(std::int64_t count, std::int64_t bytes_each, Place place);
  /// Throws the Error for a promise that the file does not keep: `found` of `promised` `what`. A
  /// `hint` follows the problem.
  [[noreturn]] void fail_promise(std::string_view what, std::int64_t promised, std::int64_t found,
                                 Place end, std::string_view hint = {}) const;
  /// Throws the Error for a problem at a place of the source.
  [[noreturn]] void fail(Place place, const std::string& problem,
                         const std::string& remedy = {}) const;

  /// Counts values that the header does not declare.
  void add_surplus_values(std::int64_t count) { scan_.surplus_values += count; }
  /// Notes a count of the file that what follows it contradicts.
  void add_wrong_count() { ++scan_.wrong_counts; }
  /// Counts lines of the header that mean nothing.
  void add_unknown_header_lines(std::int64_t count) { scan_.unknown_header_lines += count; }

  std::int64_t point_count() const { return static_cast<std::int64_t>(scan_.mesh.points.size()); }

  /// Adds a vertex. One with a coordinate that is not finite or too large is noted: `finish` drops
  /// it, and with it its faces. Throws Error if there are too many vertices.
  void add_point(double x, double y, double z, Place place) {
    const double limit = options_.max_coordinate;  // the comparisons are false for NaN
    if (!(std::abs(x) <= limit && std::abs(y) <= limit && std::abs(z) <= limit))
      return add_bad_point(x, y, z, place);
    if (point_count() >= options_.max_vertices)
      fail_limit("vertices", options_.max_vertices, place);
    scan_.mesh.points.emplace_back(x, y, z);
  }

  /// Adds a normal to that of a vertex that was added before. It is passed over if it is not
  /// finite, or if there is no such vertex: normals only help (see TriangleMesh::normals).
  void add_normal(std::int64_t vertex, const Eigen::Vector3f& normal) {
    std::vector<Eigen::Vector3f>& normals = scan_.mesh.normals;
    if (vertex < 0 || vertex >= point_count() || !normal.allFinite()) return;
    if (vertex >= std::ssize(normals))
      normals.resize(static_cast<std::size_t>(vertex) + 1, Eigen::Vector3f::Zero());
    normals[static_cast<std::size_t>(vertex)] += normal;
  }

  /// Throws Error if a face has too many corners. It must be called before they are collected.
  void check_corner_count(std::int64_t count, Place place) const {
    if (count > kMaxCorners) fail_corner_count(place);
  }
  /// Adds a face of up to kMaxCorners corners, zero-based. Corners may come later in the file,
  /// unless promise_points was called.
  void add_face(std::span<const std::int64_t> corners, Place place);

  /// Adds the triangles between the rays of a grid whose points have been added. Rays that met a
  /// point that cannot be used have met nothing.
  void add_grid(kernels::RangeGrid grid, Place place);

  /// Does what had to wait for the last vertex and returns the scan. Throws Error if it has no
  /// vertices or no faces, or none without bad vertices.
  Scan finish(std::string format);

 private:
  void check_corner(std::int64_t corner, Place place) {
    if (static_cast<std::uint64_t>(corner) >= static_cast<std::uint64_t>(index_limit_))
      fail_index(corner, place);
    if (corner >= point_count() && corner > largest_ahead_) {
      largest_ahead_ = corner;
      largest_ahead_place_ = place;
    }
  }
  /// A vertex that cannot be used.
  struct BadPoint {
    std::int64_t index;
    double x, y, z;
    Place place;
  };

  void add_polygon(std::span<const std::int64_t> corners);
  void add_bad_point(double x, double y, double z, Place place);
  void drop_bad_points();
  std::vector<bool> bad_points() const;
  [[noreturn]] void fail_coordinate(const BadPoint& point) const;
  [[noreturn]] void fail_corner_count(Place place) const;
  [[noreturn]] void fail_index(std::int64_t corner, Place place) const;
  [[noreturn]] void fail_limit(std::string_view what, std::int64_t limit, Place place) const;
  [[noreturn]] void fail_without_faces() const;

  const ByteSource& source_;
  ScanOptions options_;
  Scan scan_;
  std::int64_t index_base_ = 0;
  std::int64_t index_limit_ = 0;
  bool index_limit_known_ = false;   // false: it is only the most that could be held
  std::int64_t triangle_count_ = 0;  // with those of the polygons that wait
  std::int64_t grid_count_ = 0;
  std::int64_t largest_ahead_ = -1;  // largest index met before its vertex, and where first
  Place largest_ahead_place_;
  std::vector<std::int32_t> waiting_;     // polygons met before their vertices: size, then corners
  std::vector<std::int64_t> bad_points_;  // indices
  std::optional<BadPoint> first_bad_point_;
  PolygonTriangulator triangulator_;
  std::vector<Eigen::Vector3d> polygon_;
};

}  // namespace semigeo::io
