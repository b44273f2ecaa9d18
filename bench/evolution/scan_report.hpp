#pragma once

#include <string>
#include <vector>

#include "bench/evolution/level_report.hpp"
#include "jobs/stages/prepare_surface.hpp"

namespace semigeo::evolution {

/// What one scan took from its file to its last level.
struct ScanReport {
  std::string name;
  std::int64_t scanned_vertices = 0;  ///< after repair, before holes are filled and decimation
  Seconds reading;
  Seconds repair;
  Seconds filling;
  Seconds decimation;
  Seconds ordering;
  Seconds normals;  ///< of level 0, and all else before the first patch
  jobs::PreparationResult preparation;
  std::vector<LevelReport> levels;

  /// Of all levels together.
  Seconds smoothing() const;
  Seconds remeshing() const;
};

/// A table on stdout, with CPU seconds.
void print(const ScanReport& scan);
/// One row a level.
std::string csv(const std::vector<ScanReport>& scans);
std::string json(const std::vector<ScanReport>& scans);
/// Area and volume, as shares of level 0's, and parts, over the levels.
std::string plots(const std::vector<ScanReport>& scans);

}  // namespace semigeo::evolution
