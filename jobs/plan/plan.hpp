#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/archive/scan_size.hpp"
#include "jobs/plan/job.hpp"
#include "jobs/plan/reasons.hpp"

namespace semigeo::jobs {

/// A job and what is known of it before anything runs.
struct PlannedJob {
  Job job;
  std::vector<std::size_t> after = {};  ///< Places in the plan, before this one, of the jobs that
                                        ///< must have ended before this job may begin.
  bool up_to_date = false;
  bool inputs_are_there = false;    ///< The key stands: inputs are not looked at again.
  std::vector<Reason> reasons;      ///< Why the job runs; empty if it does not.
  std::string error;                ///< Why the job cannot even be planned.
  std::filesystem::path scan;       ///< Absolute path of the scan that the job reads, if any.
  std::uintmax_t member_bytes = 0;  ///< Size of that scan if it is a member of a container.
};

/// Returns whether the inputs of the job could be looked at.
inline bool is_readable(const PlannedJob& planned) {
  return planned.error.empty();
}

/// Returns "up to date", "would run" or "unreadable".
std::string_view state_of(const PlannedJob& planned);

/// Returns the format and the size of the scan that is the job's input.
ScanSize scan_size(const PlannedJob& planned);

/// Returns the bytes of scans that the job is going to read.
std::uintmax_t bytes_to_read(const PlannedJob& planned);

/// Compares the key of the output that is there with the job's, and sets `up_to_date` or the reason
/// why the job runs. If the system refuses to read the output, the job fails instead
/// (fail_to_read).
void judge_output(PlannedJob& planned, KeyCheck check = KeyCheck::kWhole);

/// Marks a job as failed because the system refuses to read its output. What there is stays: it may
/// be whole.
void fail_to_read(PlannedJob& planned, const std::string& problem);

/// Plans a job again whose output is damaged. `problem` says what is wrong.
void plan_again(PlannedJob& planned, const std::string& problem);

/// Removes, before jobs run, damaged outputs that look up to date to readers of headers.
void remove_damaged_outputs(const std::vector<PlannedJob>& plan);

}  // namespace semigeo::jobs
