#include "jobs/run/scheduler.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace semigeo::jobs {
namespace {

using Numbers = std::vector<std::size_t>;

ScheduledJob job(double seconds, Numbers after = {}, double bytes = 0) {
  return {.after = std::move(after), .estimate = {.peak_bytes = bytes, .seconds = seconds}};
}

SchedulerOptions cores(int count, std::uint64_t bytes = 1000) {
  return {.total = {.cores = count, .bytes = bytes}};
}

/// Starts whatever may start now; returns it in order.
Numbers start_all(Scheduler& scheduler, double now = 0) {
  Numbers started;
  while (const auto next = scheduler.next(now)) {
    if (!scheduler.admit(*next)) break;
    started.push_back(*next);
  }
  return started;
}

TEST(SchedulerTest, TheLongestJobsComeFirst) {
  Scheduler scheduler({job(1), job(3), job(2), job(3)}, cores(4));
  EXPECT_EQ(start_all(scheduler), (Numbers{1, 3, 2, 0}));
  EXPECT_EQ(scheduler.running(), 4u);
}

TEST(SchedulerTest, CoresAreAdmitted) {
  Scheduler scheduler({job(1), job(1), job(1)}, cores(2));
  EXPECT_EQ(start_all(scheduler), (Numbers{0, 1}));
  scheduler.end(0, JobState::kDone);
  EXPECT_EQ(start_all(scheduler), (Numbers{2}));
}

TEST(SchedulerTest, MemoryIsAdmittedAndNothingOvertakesWhatWaitsForIt) {
  Scheduler scheduler({job(3, {}, 600), job(2, {}, 600), job(1, {}, 100)}, cores(4, 1000));
  EXPECT_EQ(start_all(scheduler), (Numbers{0}));
  EXPECT_EQ(start_all(scheduler), Numbers{});  // 2 would fit
  scheduler.end(0, JobState::kFailed);
  EXPECT_EQ(start_all(scheduler), (Numbers{1, 2}));
}

TEST(SchedulerTest, AJobThatNeedsMoreThanThereIsRunsAlone) {
  Scheduler scheduler({job(3, {}, 5000), job(2, {}, 10)}, cores(2, 1000));
  EXPECT_EQ(start_all(scheduler), (Numbers{0}));
  scheduler.end(0, JobState::kDone);
  EXPECT_EQ(start_all(scheduler), (Numbers{1}));
}

TEST(SchedulerTest, AJobGetsAsManyCoresAsItsShareOfTheTimeThatIsLeft) {
  Scheduler alone({job(10)}, cores(8));
  EXPECT_EQ(alone.admit(0)->cores, 8);
  Scheduler half({job(10), job(5), job(5)}, cores(8));
  EXPECT_EQ(half.admit(0)->cores, 4);
  Scheduler many(std::vector<ScheduledJob>(100, job(1)), cores(8));
  EXPECT_EQ(many.admit(0)->cores, 1);
  // What waits for another job does not count yet.
  Scheduler first({job(10), job(1000, {0})}, cores(8));
  EXPECT_EQ(first.admit(0)->cores, 8);
}

TEST(SchedulerTest, AJobWaitsUntilThoseBeforeItHaveEndedWellOrNot) {
  for (const JobState state : {JobState::kDone, JobState::kUpToDate, JobState::kFailed}) {
    Scheduler scheduler({job(1), job(1), job(9, {0, 1})}, cores(4));
    EXPECT_EQ(start_all(scheduler), (Numbers{0, 1}));
    scheduler.end(0, JobState::kDone);
    EXPECT_EQ(start_all(scheduler), Numbers{});
    scheduler.end(1, state);
    EXPECT_EQ(scheduler.follows_failure(2), state == JobState::kFailed);
    EXPECT_EQ(start_all(scheduler), (Numbers{2}));
  }
}

TEST(SchedulerTest, WhatDoesNotRunIsNotWaitedFor) {
  std::vector<ScheduledJob> jobs = {job(1), job(1), job(1, {0}), job(1, {1})};
  jobs[0].state = JobState::kUpToDate;
  jobs[1].state = JobState::kFailed;
  Scheduler scheduler(jobs, cores(4));
  EXPECT_EQ(start_all(scheduler), (Numbers{2, 3}));
  EXPECT_FALSE(scheduler.follows_failure(2));
  EXPECT_TRUE(scheduler.follows_failure(3));
}

TEST(SchedulerTest, ASkippedJobPassesItsFailureOn) {
  Scheduler scheduler({job(1), job(1, {0}), job(1, {1})}, cores(1));
  start_all(scheduler);
  scheduler.end(0, JobState::kFailed);
  ASSERT_EQ(scheduler.next(0), 1u);
  scheduler.end(1, JobState::kSkipped);  // it was never started
  EXPECT_EQ(scheduler.running(), 0u);
  EXPECT_TRUE(scheduler.follows_failure(2));
  EXPECT_EQ(start_all(scheduler), (Numbers{2}));
}

TEST(SchedulerTest, NothingStartsThatWouldNotEndInTime) {
  SchedulerOptions options = cores(2);
  options.most_seconds = 100;
  Scheduler scheduler({job(150), job(60), job(30)}, options);
  // The first gets one core: 150 s. The others would take 60 and 30.
  EXPECT_EQ(scheduler.next(0), 1u);
  EXPECT_EQ(start_all(scheduler, 50), (Numbers{2}));
  EXPECT_EQ(scheduler.next(71), std::nullopt);
}

TEST(SchedulerTest, ALostJobIsTriedAgainFirst) {
  SchedulerOptions options = cores(1);
  options.retries = 1;
  Scheduler scheduler({job(1), job(9)}, options);
  EXPECT_EQ(start_all(scheduler), (Numbers{1}));
  EXPECT_EQ(scheduler.attempts(1), 1);
  EXPECT_EQ(scheduler.lose(1, false), Scheduler::Loss::kRetry);
  EXPECT_EQ(scheduler.running(), 0u);
  EXPECT_EQ(start_all(scheduler), (Numbers{1}));
  EXPECT_EQ(scheduler.attempts(1), 2);
  EXPECT_EQ(scheduler.lose(1, false), Scheduler::Loss::kFailed);
  EXPECT_EQ(start_all(scheduler), (Numbers{0}));
}

TEST(SchedulerTest, WhatTheRunItselfEndsHasNotRun) {
  Scheduler scheduler({job(1), job(1, {0})}, cores(1));
  start_all(scheduler);
  scheduler.stop();
  EXPECT_EQ(scheduler.lose(0, true), Scheduler::Loss::kNotRun);
  EXPECT_EQ(scheduler.running(), 0u);
  EXPECT_EQ(scheduler.next(0), std::nullopt);
}

TEST(SchedulerTest, WhenItStopsWhatRunsGoesOnAndNothingStarts) {
  Scheduler scheduler({job(1), job(1)}, cores(1));
  start_all(scheduler);
  scheduler.stop();
  EXPECT_EQ(scheduler.running(), 1u);
  EXPECT_EQ(scheduler.lose(0, false), Scheduler::Loss::kFailed);  // no more attempts
  EXPECT_EQ(scheduler.next(0), std::nullopt);
}

TEST(SchedulerTest, FailFastStopsAtTheFirstFailure) {
  SchedulerOptions options = cores(1);
  options.fail_fast = true;
  Scheduler scheduler({job(2), job(1)}, options);
  start_all(scheduler);
  scheduler.end(0, JobState::kFailed);
  EXPECT_TRUE(scheduler.stopping());
  EXPECT_EQ(scheduler.next(0), std::nullopt);
  std::vector<ScheduledJob> unreadable = {job(1), job(1)};
  unreadable[0].state = JobState::kFailed;
  EXPECT_EQ(Scheduler(unreadable, options).next(0), std::nullopt);
}

TEST(SchedulerTest, ARunnerThatOrdersJobsIsGivenAllAtOnce) {
  SchedulerOptions options = cores(1);
  options.all_at_once = true;
  options.most_seconds = 1;
  Scheduler scheduler({job(9, {}, 1e9), job(9, {0}), job(9, {1})}, options);
  EXPECT_EQ(start_all(scheduler), (Numbers{0, 1, 2}));
  scheduler.end(2, JobState::kFailed);
  scheduler.end(0, JobState::kDone);
  EXPECT_EQ(scheduler.lose(1, true), Scheduler::Loss::kNotRun);
  EXPECT_EQ(scheduler.running(), 0u);
}

}  // namespace
}  // namespace semigeo::jobs
