#include "jobs/plan/job_kind.hpp"

#include <nlohmann/json.hpp>

namespace semigeo::jobs {

bool JobKind::has_all_outputs(const Job&) const {
  return true;
}

void JobKind::discard_output(const Job& job) const {
  std::error_code ignored;
  std::filesystem::remove(job.output, ignored);
}

bool JobKind::resolve_inputs(Job& job, OutputKeys&) const {
  return is_complete(job);
}

void JobKind::remove_stale_output(const Job&) const {}

std::vector<ExternalFile> JobKind::external_files(const PlannedJob&) const {
  return {};
}

Estimate JobKind::estimate(const PlannedJob&, const EstimateContext&) const {
  return {};
}

std::uintmax_t JobKind::bytes_to_read(const Job&) const {
  return 0;
}

bool JobKind::fills_large_arrays() const {
  return false;
}

std::int64_t JobKind::vertex_levels(const std::any&) const {
  return 0;
}

void JobKind::describe(const Job&, const std::any&, JobEnded&) const {}

JobReport JobKind::report(const Job&, const std::any&) const {
  return {};
}

std::optional<JobSummary> JobKind::summary(const Job&, JobState) const {
  return {};
}

bool JobKind::remember(const Job&, DigestCache&) const {
  return false;
}

void JobKind::clean_up(const Job&) const {}

io::Error missing_input(const std::filesystem::path& output, const std::string& input) {
  return {output, "", "there is no " + input + " to make it of",
          "see why the jobs before it failed, and run again"};
}

const JobKind* JobKinds::find(std::string_view name) const {
  for (const JobKind* kind : kinds_)
    if (kind->words().kind == name) return kind;
  return nullptr;
}

}  // namespace semigeo::jobs
