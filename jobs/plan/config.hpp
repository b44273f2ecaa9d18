#pragma once

#include <filesystem>
#include <vector>

#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs {

/// What jobs depend on besides their inputs: each kind on its part.
struct JobParameters {
  SurfaceParameters surface = {};
  RecognitionParameters recognition = {};
  SearchParameters search = {};
};

/// What `semigeo run` was asked to do.
struct RunConfig {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path archive;
  JobParameters jobs;
  int threads = 0;  ///< 0: all cores
};

}  // namespace semigeo::jobs
