#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "engine/run_context.hpp"
#include "jobs/stages/recognition_parameters.hpp"

namespace semigeo::jobs {

/// A job that reads a dataset and writes the run of a model (io/library/triplet_run.hpp).
struct TripletsJob {
  std::filesystem::path dataset;
  std::string name;  ///< Name of the model.
  std::filesystem::path output;
  /// Takes the key of the dataset and returns the hash of everything that the run depends on.
  std::function<std::string(const std::string&)> key_of;
};

/// Describes the output of a triplets job.
struct TripletsJobResult {
  std::int64_t features = 0;
  std::int64_t samples = 0;
  std::int64_t triplets = 0;
};

/// Writes the run. Throws io::Error if the dataset cannot be read or the run cannot be written. The
/// result does not depend on the number of threads.
TripletsJobResult run_triplets_job(const TripletsJob& job, const RecognitionParameters& parameters,
                                   const engine::RunContext& context);

}  // namespace semigeo::jobs
