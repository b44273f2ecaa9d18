#pragma once

#include <filesystem>
#include <vector>

#include "jobs/archive/find_scans.hpp"
#include "jobs/kinds/surface_plan.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::tests {

/// Scans, the archive that is made of them, and how.
struct ScansToRun {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path archive;
  jobs::SurfaceParameters surface = {};
  jobs::RecognitionParameters recognition = {};
  int threads = 0;
};

/// Plans the surface jobs of all scans, without the help of a cache.
inline std::vector<jobs::PlannedJob> plan_scans(const ScansToRun& scans) {
  jobs::DigestCache nothing(scans.archive);
  return jobs::plan_surfaces(scans.archive, jobs::find_scans(scans.inputs, scans.archive).scans,
                             scans.surface, nothing, scans.threads);
}

}  // namespace semigeo::tests
