#include "jobs/plan/job_state.hpp"

namespace semigeo::jobs {

std::string_view name_of(JobState state) {
  switch (state) {
    case JobState::kDone:
      return "done";
    case JobState::kUpToDate:
      return "up to date";
    case JobState::kFailed:
      return "failed";
    case JobState::kSkipped:
      return "skipped";
    case JobState::kNotRun:
      break;
  }
  return "not run";
}

}  // namespace semigeo::jobs
