#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/run_context.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/repair/remeshing.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::evolution {

/// By the clock on the wall, and of all threads together.
struct Seconds {
  double wall = 0;
  double cpu = 0;

  Seconds& operator+=(const Seconds& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
  }
  Seconds operator-(const Seconds& other) const { return {wall - other.wall, cpu - other.cpu}; }
};

/// One level of one scan. Lengths are in the scan's unit where nothing else is said.
struct LevelReport {
  std::int64_t vertices = 0;
  std::int64_t triangles = 0;
  std::int64_t parts = 0;
  std::int64_t boundary_edges = 0;
  /// Mean over the descendants of level 0, in mean edge lengths of level 0; NaN without any.
  double moved = 0;  ///< since the level before
  double moved_from_first = 0;
  double volume = 0;  ///< of the parts that enclose one
  double area = 0;
  double mean_edge = 0;
  double shortest_edge = 0;
  kernels::RemeshCounts remeshed;  ///< on the way from the level before
  Seconds remeshing;               ///< on the way from the level before
  Seconds smoothing;               ///< this level's curvature, and the smoothing to the next
};

/// A number of a level under the name that it has in tables.
struct Column {
  const char* name;
  double (*value)(const LevelReport&);
  bool whole;  ///< a count
};
std::span<const Column> columns();

/// Measures levels one after the other, and follows the vertices of level 0 through them.
class LevelMeter {
 public:
  /// `first` as it was built, before its vertices were put in another order.
  explicit LevelMeter(const kernels::Surface& first);

  /// All but the seconds.
  LevelReport measure(const jobs::LevelFields& fields, const engine::RunContext& context);

 private:
  void adopt(const jobs::LevelConnectivity& connectivity);

  kernels::LevelMesh mesh_;  ///< in the order of the level's rows
  double first_edge_;
  std::vector<Eigen::Vector3f> first_points_;
  std::vector<std::int32_t> before_source_;
  std::vector<Eigen::Vector3f> before_points_;
};

}  // namespace semigeo::evolution
