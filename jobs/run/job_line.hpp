#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "jobs/plan/config.hpp"
#include "jobs/plan/job.hpp"
#include "jobs/run/job_result.hpp"

namespace semigeo::jobs {

// What a run and the processes that do its jobs say to each other: one line of JSON each.

/// A job, to be done by another process.
struct JobRequest {
  Job job;
  JobParameters parameters;
  bool sidecar_only = false;       ///< make the dataset's .xdmf again, if that is possible
  int threads = 1;                 ///< at once
  std::uint64_t memory_bytes = 0;  ///< address space; 0: no limit
  std::filesystem::path log;       ///< takes what the job prints; appended to
};

/// What became of it. Neither done nor failed: so much work was done meanwhile.
struct JobReply {
  enum class Kind { kWorked, kDone, kFailed };
  Kind kind = Kind::kFailed;
  std::int64_t worked = 0;  ///< vertices times levels since the last reply
  std::string error;        ///< of a failed job: one sentence
  JobResult result;         ///< of a job that is done
  double cpu_seconds = 0;   ///< of this job
  double peak_bytes = 0;    ///< resident at once, of the process while it ran
};

std::string to_line(const JobRequest& request);
std::string to_line(const JobReply& reply);

/// Throw std::runtime_error on a line that is none.
JobRequest job_request_from(const std::string& line);
JobReply job_reply_from(const std::string& line);

}  // namespace semigeo::jobs
