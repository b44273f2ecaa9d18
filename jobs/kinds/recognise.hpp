#pragma once

#include <filesystem>
#include <string>

#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "jobs/stages/search_parameters.hpp"

namespace semigeo::jobs {

/// What a recognise job knows besides its head: a scene and a library become the list of the models
/// that are in the scene.
struct RecogniseJobData {
  std::string input_name = {};            ///< What the output says of the scene's name, as UTF-8.
  std::string input_xxh3 = {};            ///< Digest of the scene's bytes.
  std::filesystem::path library = {};     ///< Where the models are looked for.
  std::string library_digest = {};        ///< Digest of the library's content.
  RecognitionParameters parameters = {};  ///< Of the library: estimates depend on them.
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
