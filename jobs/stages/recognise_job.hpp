#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

/// Scene and library in, what of the library is in the scene out (recognised_file.hpp).
struct RecogniseJob {
  std::filesystem::path scene;  ///< a scan or a dataset
  std::string input_name;       ///< what the output says of it, as UTF-8
  std::string name;
  std::string input_xxh3;  ///< of the scene's bytes
  std::filesystem::path library;
  std::string library_digest;  ///< of its content
  std::filesystem::path output;
  std::string key;  ///< hash of everything the output depends on
};

struct RecogniseJobResult {
  std::int64_t features = 0;  ///< of the scene
  std::int64_t triplets = 0;  ///< of them
  std::int64_t objects = 0;   ///< that were found
};

/// The parameters with which features of a scene must be found to be compared with the library's.
/// Throws io::Error if they are none that this program knows.
RecognitionParameters parameters_of(const io::HashLibrary& library);

/// The least score of an object, if nobody says another. kThesis has none: its score is the size of
/// a cluster, which grows with the number of features and tells what is there from what is not only
/// beside that of other models.
double default_min_score(RecognitionMethod method);

/// Throws io::Error on an unreadable or unusable scene, on a damaged library, if one of them has
/// changed meanwhile, and when the output cannot be written. The bytes of the output do not depend
/// on the number of threads.
RecogniseJobResult run_recognise_job(const RecogniseJob& job, const SearchParameters& parameters,
                                     const engine::RunContext& context);

}  // namespace semigeo::jobs
