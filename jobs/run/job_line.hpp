#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

// What a run and the processes that do its jobs say to each other: each message is a line of JSON.

/// A job that another process is to do.
struct JobRequest {
  Job job;
  int threads = 1;                        ///< Threads that the job may use at once.
  std::uint64_t memory_bytes = 0;         ///< Memory of all jobs; 0: the user gave no limit.
  std::uint64_t address_space_bytes = 0;  ///< Address space of the process; 0: no limit.
  std::filesystem::path log;              ///< The file to which the output of the job is appended.
};

/// The outcome of a job, or the work that was done since the last reply.
struct JobReply {
  /// Tells whether the job goes on, is done, or has failed.
  enum class Kind { kWorked, kDone, kFailed };
  Kind kind = Kind::kFailed;
  std::int64_t worked = 0;     ///< Vertices times levels since the last reply.
  std::string error = {};      ///< Why the job failed: one sentence.
  nlohmann::json result = {};  ///< Result of a job that is done, as its kind writes it, or null.
  double cpu_seconds = 0;      ///< CPU time of this job.
  double peak_bytes = 0;       ///< The most memory that the process had resident during the job.
  bool last = false;           ///< The process does no more jobs.
  int write_error = 0;         ///< The errno if the output could not be written; otherwise 0.
};

/// Returns the message as one line without its end.
std::string to_line(const JobRequest& request);
std::string to_line(const JobReply& reply);

/// Reads a message. Throws std::runtime_error if the line is no such message, or if the job is of
/// none of the kinds.
JobRequest job_request_from(const std::string& line, const JobKinds& kinds);
JobReply job_reply_from(const std::string& line);

}  // namespace semigeo::jobs
