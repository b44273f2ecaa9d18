#pragma once

#include <filesystem>
#include <string>

#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

/// The data of a recognise job, which lists the models of a library that are in a scene.
struct RecogniseJobData {
  std::string input_name = {};            ///< Name of the scene in the output, as UTF-8.
  std::string input_xxh3 = {};            ///< Digest of the scene's bytes.
  std::filesystem::path library = {};     ///< File of the library.
  std::string library_digest = {};        ///< Digest of the library's content.
  RecognitionParameters parameters = {};  ///< Those of the library, for estimates.
  SearchParameters search = {};
};

/// The kind whose jobs recognise models in one scene (jobs/stages/recognise_job.hpp). The data of
/// its jobs is a RecogniseJobData, their result a RecogniseJobResult.
const JobKind& recognise_kind();

/// Returns the data of a recognise job.
const RecogniseJobData& recognise_data(const Job& job);

/// Returns the key of what is recognised in the scene of this name under these conditions.
std::string recognise_key(const std::string& name, const RecogniseJobData& data);

}  // namespace semigeo::jobs
