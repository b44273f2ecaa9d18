#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

/// A job that finds models of a library in a scene and writes them to a file (recognised_file.hpp).
struct RecogniseJob {
  std::filesystem::path scene;  ///< File of a scan or a dataset.
  std::string input_name;       ///< Name of the scene in the output, as UTF-8.
  std::string name;
  std::string input_xxh3;  ///< Digest of the scene's bytes.
  std::filesystem::path library;
  std::string library_digest;  ///< Digest of the library's content.
  std::filesystem::path output;
  std::string key;  ///< Hash of everything the output depends on.
};

/// Counts what a recognise job found.
struct RecogniseJobResult {
  std::int64_t features = 0;  ///< Number of features of the scene.
  std::int64_t triplets = 0;  ///< Number of triplets of these features.
  std::int64_t objects = 0;   ///< Number of objects found.
};

/// Returns the parameters with which features of a scene must be found, so that they can be
/// compared with those of the library. Throws io::Error if this program does not know the
/// parameters.
RecognitionParameters parameters_of(const io::HashLibrary& library);

/// Returns the least score of an object if none is given. For kThesis it is 0: there a score is the
/// size of a cluster, which grows with the number of features, so that scores can only be compared
/// within one scene.
double default_min_score(RecognitionMethod method);

/// Writes the file. Throws io::Error if the scene cannot be read or used, if the library is
/// damaged, if one of them has changed meanwhile, or if the output cannot be written. The bytes of
/// the output do not depend on the number of threads.
RecogniseJobResult run_recognise_job(const RecogniseJob& job, const SearchParameters& parameters,
                                     const engine::RunContext& context);

}  // namespace semigeo::jobs
