#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "kernels/repair/range_grid.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::io {

/// Returns whether a file's name is that of a scan: it has the extension of a format in any case,
/// before a last ".gz", ".bz2", ".xz" or
/// ".zst" if there is one. The file is not looked at.
bool is_scan_name(const std::filesystem::path& path);

/// Returns the variant of the format that the first bytes of a file show: "PLY ascii", "STL binary,
/// gzip". Returns an empty text if the name is not that of a scan. Throws `Error` if the file
/// cannot be read.
std::string scan_variant(const std::filesystem::path& path);

/// Returns the variant that the name alone makes likely: the one with the most vertices in a byte.
std::string likely_scan_variant(const std::filesystem::path& path);

/// Returns the extensions of all formats in words: ".ply, .obj, .off and .stl" for ", " and " and
/// ".
std::string scan_extensions(std::string_view separator, std::string_view last_separator);

/// Says what a scan may hold before it is refused, and how a grid of points becomes a surface.
struct ScanOptions {
  std::int64_t max_vertices = 200'000'000;   ///< Indices are 32 bits wide, so never above 2^31 - 2.
  std::int64_t max_triangles = 400'000'000;  ///< Counted after cutting polygons into triangles.
  double max_coordinate = 1e30;              ///< Keeps areas and volumes within a double's range.
  double depth_jump = kernels::kDepthJump;   ///< See `kernels::triangulate_grid`.
};

/// Holds the content of a scan file.
struct Scan {
  kernels::TriangleMesh mesh;  ///< As the file lists it. An STL has three points for each triangle.
  /// XXH3-128 of the bytes that were read, with those of companions (companions.hpp).
  std::string xxh3;
  std::string format;  ///< "PLY binary little endian", "OBJ", "STL ascii, gzip", ...
  std::int64_t polygons_triangulated = 0;  ///< Faces with more than three corners.
  /// Bytes that are not blank, behind all that the header promises.
  std::int64_t bytes_after_end = 0;
  std::int64_t faces_skipped = 0;  ///< Faces with one or two corners, or none.
  /// Vertices with coordinates that are not finite or implausibly large. They lie at the origin and
  /// belong to no face.
  std::int64_t bad_vertices = 0;
  std::int64_t faces_of_bad_vertices = 0;  ///< Triangles that were dropped with them.
  std::int64_t wrong_counts = 0;           ///< Counts of the file that its size contradicts.
  std::int64_t surplus_values = 0;         ///< Values of a text that its header does not declare.
  std::int64_t unknown_header_lines = 0;   ///< Lines of a header that mean nothing.
  /// Triangles of a range grid that would have joined surfaces at different depths.
  std::int64_t depth_jump_triangles = 0;
  /// The scanner's place, in the frame of the mesh. It is known only of scans that are one range
  /// grid, and only if the file names it.
  std::optional<Eigen::Vector3d> eye;
};

/// Reads a surface from a file of one of the formats in scan_formats.hpp, plain or compressed,
/// alone or in a container of files. Everything in the file other than positions and faces is read
/// over. A grid of points that a scanner measured (an organised PCD, a PTX, a PLY with `range_grid`
/// and no faces) is triangulated.
///
/// Every vertex is finite and every index valid in what it returns; it may still be degenerate or
/// not a manifold. Everything else throws `Error`: no such file, another format than the name says,
/// more promised in a header than the file holds, no triangle with finite coordinates, indices out
/// of range, no vertices, no faces (a point cloud), more than `options` admit.
///
/// Streams through a buffer of 1 MiB; memory is that of the mesh, for glTF and .vtp also that of
/// the file, and never follows a promise of a header. Several threads may call the function at
/// once.
Scan read_scan(const std::filesystem::path& path, const ScanOptions& options = {});

}  // namespace semigeo::io
