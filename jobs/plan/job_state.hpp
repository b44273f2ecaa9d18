#pragma once

#include <string_view>

namespace semigeo::jobs {

/// The state of a job at the end of a run.
enum class JobState {
  kDone,
  kUpToDate,
  kFailed,
  kSkipped,  ///< Its inputs are not there, because a job before it has failed.
  kNotRun    ///< The run stopped before the job could run.
};

/// Returns "done", "up to date", "failed", "skipped" or "not run".
std::string_view name_of(JobState state);

/// Returns whether nothing more will become of the job, so that jobs after it need not wait.
constexpr bool has_ended(JobState state) {
  return state != JobState::kNotRun;
}

/// Returns whether the output of the job is there.
constexpr bool is_made(JobState state) {
  return state == JobState::kDone || state == JobState::kUpToDate;
}

}  // namespace semigeo::jobs
