#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "jobs/plan/config.hpp"
#include "jobs/plan/job.hpp"

namespace semigeo::jobs {

/// Makes of planned jobs jobs of the inputs that are there. A plan is made as if every job were
/// going to be done; when one has failed, what follows takes what there is, and its key says so.
/// Looks at files only, so that it does not matter who ran the jobs before, and where.
class JobInputs {
 public:
  explicit JobInputs(RecognitionParameters parameters) : parameters_(parameters) {}

  /// To be called when the jobs before it have ended; surface jobs and
  /// recognitions are left as they are. Triplets: of the dataset that is there. Partition, library:
  /// of the models that have runs. Returns whether what it would make is there, or is not needed:
  /// partitions of a library that is. io::Error if something to begin with is missing.
  bool settle(Job& job);

 private:
  bool settle_models(Job& job);
  const std::string& key_of_run(const std::filesystem::path& run);

  RecognitionParameters parameters_;
  std::map<std::filesystem::path, std::string> run_keys_;  ///< a partition asks for all of them
};

/// Removes a run that is not of the dataset that is there, so that none goes into a library. To be
/// called before its job is done; other kinds are left alone: their outputs are replaced.
void remove_stale_run(const Job& job);

}  // namespace semigeo::jobs
