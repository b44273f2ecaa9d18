#pragma once

#include <string>
#include <vector>

#include "bench/evolution/level_report.hpp"
#include "jobs/stages/prepare_surface.hpp"

namespace semigeo::evolution {

/// Tells how long each step took from the file of a scan to its last level.
struct ScanReport {
  std::string name;
  std::int64_t scanned_vertices = 0;  ///< Number of vertices after repair, before preparation.
  Seconds reading;
  Seconds repair;
  Seconds filling;
  Seconds decimation;
  Seconds ordering;
  Seconds normals;  ///< Time for the normals of level 0 and all else before patches.
  jobs::PreparationResult preparation;
  std::vector<LevelReport> levels;

  /// Returns the time for smoothing all levels.
  Seconds smoothing() const;
  /// Returns the time for remeshing all levels.
  Seconds remeshing() const;
};

/// Prints a table of the levels on stdout, with CPU seconds.
void print(const ScanReport& scan);
/// Returns a CSV file with one row for each level of each scan.
std::string csv(const std::vector<ScanReport>& scans);
/// Returns the same as JSON, with the times of each scan.
std::string json(const std::vector<ScanReport>& scans);
/// Returns an SVG document with the area and the volume of each level, as shares of those of
/// level 0, and the number of parts.
std::string plots(const std::vector<ScanReport>& scans);

}  // namespace semigeo::evolution
