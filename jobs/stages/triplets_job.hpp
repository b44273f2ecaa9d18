#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "engine/run_context.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// Dataset in, run (io/library/triplet_run.hpp) out.
struct TripletsJob {
  std::filesystem::path dataset;
  std::string name;  ///< of the model
  std::filesystem::path output;
  /// From the key of the dataset that is read, a hash of everything the run depends on.
  std::function<std::string(const std::string&)> key_of;
};

struct TripletsJobResult {
  std::int64_t features = 0;
  std::int64_t samples = 0;
  std::int64_t triplets = 0;
};

/// Throws io::Error on a dataset that cannot be read and when the run cannot be written. The result
/// does not depend on the number of threads.
TripletsJobResult run_triplets_job(const TripletsJob& job, const RecognitionParameters& parameters,
                                   const engine::RunContext& context);

}  // namespace semigeo::jobs
