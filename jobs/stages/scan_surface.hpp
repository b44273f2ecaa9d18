#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

/// Calls visit(name, count) for every count of some repairs, under its name in JSON. `Repairs` is
/// `kernels::SurfaceRepairs`, const or not.
template <typename Repairs, typename Visit>
void each_repair(Repairs& repairs, const Visit& visit) {
  visit("welded_vertices", repairs.welded_vertices);
  visit("gap_vertices", repairs.gap_vertices);
  visit("degenerate_faces", repairs.degenerate_faces);
  visit("duplicate_faces", repairs.duplicate_faces);
  visit("flipped_faces", repairs.flipped_faces);
  visit("nonmanifold_edges", repairs.nonmanifold_edges);
  visit("turned_parts", repairs.turned_parts);
  visit("split_vertices", repairs.split_vertices);
  visit("isolated_vertices", repairs.isolated_vertices);
}

/// Counts what was changed and passed over while a scan was read and repaired.
struct ScanRepairs {
  kernels::SurfaceRepairs surface;
  std::int64_t polygons_triangulated = 0;  ///< Faces with more than three corners.
  std::int64_t faces_skipped = 0;          ///< Faces with fewer than three corners.
  std::int64_t bad_vertices = 0;           ///< Dropped: not finite or implausibly large.
  std::int64_t faces_of_bad_vertices = 0;  ///< Triangles dropped with them.
  std::int64_t bytes_after_end = 0;        ///< Bytes behind all that the scan's header promises.
  std::int64_t wrong_counts = 0;           ///< Counts of the file that its size contradicts.
  std::int64_t surplus_values = 0;         ///< Values of a text that its header does not declare.
  std::int64_t unknown_header_lines = 0;   ///< Lines of a header that mean nothing.
  std::int64_t depth_jump_triangles = 0;   ///< Triangles of a range grid that joined two depths.

  bool operator==(const ScanRepairs&) const = default;
};

/// Calls visit(name, count) for every count that few scans have. JSON has it only if it is not 0.
template <typename Repairs, typename Visit>
void each_rare_repair(Repairs& repairs, const Visit& visit) {
  visit("wrong_counts", repairs.wrong_counts);
  visit("surplus_values", repairs.surplus_values);
  visit("unknown_header_lines", repairs.unknown_header_lines);
  visit("depth_jump_triangles", repairs.depth_jump_triangles);
}

/// Calls visit(name, count) for every count, under its name in JSON. `Repairs` is `ScanRepairs`,
/// const or not.
template <typename Repairs, typename Visit>
void each_scan_repair(Repairs& repairs, const Visit& visit) {
  each_repair(repairs.surface, visit);
  visit("polygons_triangulated", repairs.polygons_triangulated);
  visit("faces_skipped", repairs.faces_skipped);
  visit("bad_vertices", repairs.bad_vertices);
  visit("faces_of_bad_vertices", repairs.faces_of_bad_vertices);
  visit("bytes_after_end", repairs.bytes_after_end);
  each_rare_repair(repairs, visit);
}

/// The repaired surface of a scan file.
struct ScanSurface {
  kernels::BuiltSurface built;
  std::string format;  ///< Format of the scan: "PLY binary little endian", ...
  ScanRepairs repairs;
  /// The place of the scanner in the coordinates of the file, if the file names it.
  std::optional<Eigen::Vector3d> eye = {};
};

/// Returns the counts as JSON with sorted keys.
nlohmann::json json_of(const kernels::SurfaceRepairs& repairs);
nlohmann::json json_of(const ScanRepairs& repairs);

/// Returns the counts as the text of their JSON.
std::string to_json(const kernels::SurfaceRepairs& repairs);

/// Reads and repairs a scan. `xxh3` is the digest that its bytes had when the job was planned.
/// `depth_jump` is what kernels::triangulate_grid takes, if the scan is a range grid. Throws
/// io::Error if the scan cannot be read, has changed since then, has no usable triangle, or has
/// lengths that single precision cannot hold.
ScanSurface read_surface(const std::filesystem::path& scan, const std::string& xxh3,
                         double depth_jump, const kernels::Welding& welding = {});

}  // namespace semigeo::jobs
