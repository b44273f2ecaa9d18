#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/run_context.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/repair/remeshing.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::evolution {

/// Holds a time in seconds.
struct Seconds {
  double wall = 0;  ///< Time on the clock.
  double cpu = 0;   ///< CPU time of all threads together.

  Seconds& operator+=(const Seconds& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
  }
  Seconds operator-(const Seconds& other) const { return {wall - other.wall, cpu - other.cpu}; }
};

/// Describes one level of a scan. Lengths are in the scan's length unit, except where another unit
/// is named.
struct LevelReport {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t parts = 0;
  std::int64_t boundary_edges = 0;
  // The two distances are means over the vertices that descend from level 0, in mean edge lengths
  // of level 0. They are NaN if there are no such vertices.
  double moved = 0;                ///< Distance from the place on the level before.
  double moved_from_first = 0;     ///< Distance from the place on level 0.
  double volume = 0;               ///< Volume of all parts that enclose one.
  double area = 0;                 ///< Area of all faces.
  double mean_edge = 0;            ///< Mean edge length.
  double shortest_edge = 0;        ///< Length of the shortest edge.
  kernels::RemeshCounts remeshed;  ///< What remeshing did to the level before.
  Seconds remeshing;               ///< Time for remeshing the level before.
  Seconds smoothing;               ///< Time for the curvature here and the smoothing to the next.
};

/// Describes a column of the tables of levels.
struct Column {
  const char* name;                     ///< Heading of the column.
  double (*value)(const LevelReport&);  ///< Returns the number of a level.
  bool whole;                           ///< The numbers are integers.
};
/// Returns all columns, in their order.
std::span<const Column> columns();

/// Measures levels one after the other, and follows the vertices of level 0 through them.
class LevelMeter {
 public:
  /// Begins with level 0. `first` is the surface before its vertices were put in another order.
  explicit LevelMeter(const kernels::Surface& first);

  /// Returns the report of the next level without its times.
  LevelReport measure(const jobs::LevelFields& fields, const engine::RunContext& context);

 private:
  void adopt(const jobs::LevelConnectivity& connectivity);

  kernels::LevelMesh mesh_;  ///< Vertices are in the order of the level's rows.
  double first_edge_;
  std::vector<Eigen::Vector3f> first_points_;
  std::vector<std::int32_t> before_source_;
  std::vector<Eigen::Vector3f> before_points_;
};

}  // namespace semigeo::evolution
