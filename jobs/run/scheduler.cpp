#include "jobs/run/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace semigeo::jobs {

Scheduler::Scheduler(std::vector<ScheduledJob> jobs, const SchedulerOptions& options)
    : jobs_(std::move(jobs)), options_(options), records_(jobs_.size()), resources_(options.total) {
  for (std::size_t job = 0; job < jobs_.size(); ++job) {
    if (jobs_[job].state == JobState::kFailed && options_.fail_fast) stopping_ = true;
    if (has_ended(jobs_[job].state)) continue;
    for (const std::size_t before : jobs_[job].after) {
      if (has_ended(jobs_[before].state)) continue;
      records_[before].followers.push_back(job);
      ++records_[job].waits_for;
    }
    if (records_[job].waits_for == 0) seconds_left_ += jobs_[job].estimate.seconds;
    pending_.push_back(job);
  }
  std::ranges::stable_sort(pending_, std::ranges::greater(),
                           [this](std::size_t job) { return jobs_[job].estimate.seconds; });
}

std::optional<std::size_t> Scheduler::next(double now) const {
  if (stopping_) return std::nullopt;
  const auto job =
      std::ranges::find_if(pending_, [&](std::size_t one) { return may_start(one, now); });
  return job == pending_.end() ? std::nullopt : std::optional(*job);
}

bool Scheduler::may_start(std::size_t job, double now) const {
  if (options_.all_at_once) return true;
  if (records_[job].waits_for > 0) return false;
  return options_.most_seconds <= 0 ||
         now + jobs_[job].estimate.seconds / threads_for(job) <= options_.most_seconds;
}

int Scheduler::threads_for(std::size_t job) const {
  const double share = seconds_left_ > 0 ? jobs_[job].estimate.seconds / seconds_left_ : 1;
  const int cores = options_.total.cores;
  return std::clamp(static_cast<int>(std::lround(share * cores)), 1, cores);
}

std::optional<engine::Amount> Scheduler::admit(std::size_t job) {
  engine::Amount wanted = {threads_for(job),
                           static_cast<std::uint64_t>(jobs_[job].estimate.peak_bytes)};
  if (options_.all_at_once) wanted = {};
  if (!resources_.admit(wanted)) return std::nullopt;
  std::erase(pending_, job);
  records_[job].share = wanted;
  ++records_[job].attempts;
  ++running_;
  return wanted;
}

void Scheduler::release(std::size_t job) {
  resources_.release(*records_[job].share);
  records_[job].share.reset();
  --running_;
}

void Scheduler::end(std::size_t job, JobState state) {
  if (records_[job].share) {
    release(job);
  } else {
    std::erase(pending_, job);
  }
  if (records_[job].waits_for == 0) seconds_left_ -= jobs_[job].estimate.seconds;
  jobs_[job].state = state;
  for (const std::size_t follower : records_[job].followers)
    if (--records_[follower].waits_for == 0 && !has_ended(jobs_[follower].state))
      seconds_left_ += jobs_[follower].estimate.seconds;
  if (state == JobState::kFailed && options_.fail_fast) stopping_ = true;
}

Scheduler::Loss Scheduler::lose(std::size_t job, bool wanted) {
  if (!wanted && (stopping_ || records_[job].attempts > options_.retries)) {
    end(job, JobState::kFailed);
    return Loss::kFailed;
  }
  release(job);
  if (wanted) {
    seconds_left_ -= jobs_[job].estimate.seconds;
    return Loss::kNotRun;
  }
  pending_.insert(pending_.begin(), job);
  return Loss::kRetry;
}

bool Scheduler::follows_failure(std::size_t job) const {
  return std::ranges::any_of(jobs_[job].after, [this](std::size_t before) {
    return jobs_[before].state == JobState::kFailed || jobs_[before].state == JobState::kSkipped;
  });
}

}  // namespace semigeo::jobs
