#include "jobs/plan/plan.hpp"

#include "io/files/read_error.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using Kind = Reason::Kind;

std::string_view state_of(const PlannedJob& planned) {
  if (!is_readable(planned)) return "unreadable";
  return planned.up_to_date ? "up to date" : "would run";
}

ScanSize scan_size(const PlannedJob& planned) {
  ScanSize size = scan_size(planned.job.input);
  if (planned.member_bytes > 0) size.bytes = planned.member_bytes;
  return size;
}

std::uintmax_t bytes_to_read(const PlannedJob& planned) {
  if (planned.up_to_date) return 0;
  return planned.member_bytes > 0 ? planned.member_bytes
                                  : planned.job.kind->bytes_to_read(planned.job);
}

void judge_output(PlannedJob& planned, KeyCheck check) try {
  const Job& job = planned.job;
  const JobWords& words = job.kind->words();
  if (!io::is_there(job.output)) {
    planned.reasons = {{.kind = Kind::kNoOutput, .before = words.output}};
  } else if (const std::string key = output_key(job, check); key.empty()) {
    planned.reasons = {{.kind = Kind::kUnusableOutput, .before = words.output}};
  } else if (key != job.key) {
    planned.reasons = {{.kind = Kind::kInputs, .before = words.output, .now = words.inputs}};
  } else {
    planned.up_to_date = true;
  }
} catch (const io::ReadError& error) {
  fail_to_read(planned, error.what());
}

void fail_to_read(PlannedJob& planned, const std::string& problem) {
  planned.up_to_date = false;
  planned.reasons.clear();
  planned.error = problem;
}

void plan_again(PlannedJob& planned, const std::string& problem) {
  planned.up_to_date = false;
  planned.reasons = {
      {.kind = Kind::kDamagedOutput, .before = planned.job.kind->words().output, .now = problem}};
}

void remove_damaged_outputs(const std::vector<PlannedJob>& plan) {
  std::error_code ignored;
  for (const PlannedJob& planned : plan)
    if (!planned.reasons.empty() && planned.reasons.front().kind == Kind::kDamagedOutput)
      fs::remove_all(planned.job.output, ignored);
}

}  // namespace semigeo::jobs
