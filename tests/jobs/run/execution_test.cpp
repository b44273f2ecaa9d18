#include "jobs/run/execution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <fstream>

#include "tests/jobs/run/fake_runner.hpp"
#include "tests/jobs/written_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

using Names = std::vector<std::string>;
using enum JobState;

/// Notes what it is told.
class Notes : public JobListener {
 public:
  void job_started(const PlannedJob& planned) override { lines.push_back("+" + planned.job.name); }
  void job_ended(const PlannedJob& planned, const JobOutcome& outcome) override {
    lines.push_back("-" + planned.job.name + " " + std::string(name_of(outcome.state)));
  }
  Names lines;
};

class ExecutionTest : public testing::Test {
 protected:
  ExecutionTest() { options_.total = {.cores = 1, .bytes = 1000}; }

  void add(const std::string& name, double seconds = 1, std::vector<std::size_t> after = {}) {
    plan_.push_back(tests::text_job(name, folder_.path(), {.text = name, .seconds = seconds},
                                    std::move(after)));
  }
  std::vector<JobState> run() {
    Progress progress(0, 0);
    testing::internal::CaptureStderr();
    outcomes_ = execute(plan_, runner_, options_, progress, &notes_, [this] { return now_; });
    said_ = testing::internal::GetCapturedStderr();
    vertex_levels_ = progress.vertex_levels();
    std::vector<JobState> states;
    for (const JobOutcome& outcome : outcomes_) states.push_back(outcome.state);
    return states;
  }
  bool has_said(const std::string& text) const { return said_.find(text) != std::string::npos; }

  tests::TemporaryFolder folder_;
  std::vector<PlannedJob> plan_;
  tests::FakeRunner runner_;
  ExecutionSettings options_;
  Notes notes_;
  double now_ = 0;
  std::vector<JobOutcome> outcomes_;
  std::string said_;
  std::int64_t vertex_levels_ = 0;
};

using States = std::vector<JobState>;

TEST_F(ExecutionTest, TheLongestJobsRunFirst) {
  add("short", 1);
  add("long", 3);
  add("middle", 2);
  EXPECT_EQ(run(), (States{kDone, kDone, kDone}));
  EXPECT_EQ(runner_.started, (Names{"long", "middle", "short"}));
  EXPECT_EQ(notes_.lines,
            (Names{"+long", "-long done", "+middle", "-middle done", "+short", "-short done"}));
}

TEST_F(ExecutionTest, AsManyRunSideBySideAsCoresAndMemoryAdmit) {
  for (const char* name : {"a", "b", "c", "d"}) add(name);
  options_.total.cores = 3;
  EXPECT_EQ(run(), (States(4, kDone)));
  EXPECT_EQ(runner_.most_waiting, 3u);
  tests::FakeRunner narrow;
  std::swap(runner_, narrow);
  for (PlannedJob& planned : plan_)
    planned.job.data = tests::TextJobData{.seconds = 1, .bytes = 400};
  EXPECT_EQ(run(), (States(4, kDone)));
  EXPECT_EQ(runner_.most_waiting, 2u);
}

TEST_F(ExecutionTest, WhatIsUpToDateIsNotStarted) {
  std::ofstream(folder_ / "a") << "key of a\n";
  add("a");
  add("b");
  EXPECT_EQ(run(), (States{kUpToDate, kDone}));
  EXPECT_EQ(runner_.started, Names{"b"});
}

TEST_F(ExecutionTest, WhatWasMadeMeanwhileIsUpToDate) {
  add("a");
  std::ofstream(folder_ / "a") << "key of a\n";
  EXPECT_EQ(run(), States{kUpToDate});
  EXPECT_EQ(notes_.lines, Names{"-a up to date"});
  EXPECT_TRUE(runner_.started.empty());
}

TEST_F(ExecutionTest, WhatCannotBePlannedHasFailed) {
  add("a");
  add("b");
  plan_[0].error = "a: cannot be read";
  EXPECT_EQ(run(), (States{kFailed, kDone}));
  EXPECT_TRUE(has_said("failed: a: cannot be read"));
  EXPECT_EQ(notes_.lines.front(), "+a");
  options_.fail_fast = true;
  EXPECT_EQ(run(), (States{kFailed, kNotRun}));
}

TEST_F(ExecutionTest, AJobThatItsRunnerLosesIsTriedAgain) {
  add("a");
  runner_.on_start = [&](const JobStart& job) {
    job.attempt == 1 ? runner_.lose(job.number) : runner_.answer(job.number, kDone);
  };
  EXPECT_EQ(run(), States{kDone});
  EXPECT_TRUE(has_said("again: " + folder_.path().string() + ": crashed")) << said_;
  EXPECT_EQ(notes_.lines, (Names{"+a", "-a done"}));
}

TEST_F(ExecutionTest, AJobThatItsRunnerKeepsLosingHasFailed) {
  add("a");
  add("b", 0.5);
  options_.retries = 2;
  runner_.on_start = [&](const JobStart& job) {
    job.planned->job.name == "a" ? runner_.lose(job.number) : runner_.answer(job.number, kDone);
  };
  EXPECT_EQ(run(), (States{kFailed, kDone}));
  EXPECT_EQ(runner_.started, (Names{"a", "a", "a", "b"}));
  EXPECT_EQ(outcomes_[0].error, "its job crashed; run again");
  EXPECT_EQ(outcomes_[0].attempts, 3);
}

/// A kind that cannot begin without its input.
class NeedyKind : public jobs::TypedJobKind<tests::TextJobData, tests::TextJobResult> {
 public:
  const JobWords& words() const override { return words_; }
  std::string read_key(const std::filesystem::path&, KeyCheck) const override { return ""; }
  bool resolve_inputs(Job& job, OutputKeys&) const override {
    if (!std::filesystem::exists(job.input)) throw io::Error(job.input, "", "is not there", "");
    return false;
  }
  std::any run(const Job&, const JobContext&) const override { return {}; }

 private:
  const JobWords words_ = {.kind = "needy", .output = "out", .inputs = "it", .plural = "needy"};
};

TEST_F(ExecutionTest, WhatFindsNoInputIsSkippedOnlyAfterAFailure) {
  const NeedyKind needy;
  const auto add_needy = [&](const std::string& name, std::vector<std::size_t> after) {
    add(name, 1, std::move(after));
    plan_.back().job.kind = &needy;
    plan_.back().job.input = folder_ / "none";
  };
  add("a");
  add_needy("b", {0});
  add_needy("c", {1});
  add_needy("d", {});
  runner_.on_start = [&](const JobStart& job) { runner_.answer(job.number, kFailed, "no"); };
  EXPECT_EQ(run(), (States{kFailed, kSkipped, kSkipped, kFailed}));
  EXPECT_EQ(runner_.started, Names{"a"});
  EXPECT_NE(outcomes_[1].error.find("is not there"), std::string::npos);
  // What is skipped is no failure of its own.
  std::size_t failures = 0;
  for (std::size_t at = 0; (at = said_.find("failed: ", at)) != std::string::npos; ++at) ++failures;
  EXPECT_EQ(failures, 2u) << said_;
}

TEST_F(ExecutionTest, TheFirstSignalLetsRunningJobsEnd) {
  add("a", 2);
  add("b", 1);
  runner_.on_start = [&](const JobStart& job) {
    runner_.events.emplace_back(StopAsked{1});
    runner_.answer(job.number, kDone);
  };
  EXPECT_EQ(run(), (States{kDone, kNotRun}));
  EXPECT_TRUE(has_said("1 running jobs may end"));
  EXPECT_EQ(runner_.waiting_cancelled, 1);
  EXPECT_EQ(runner_.running_cancelled, 0);
}

TEST_F(ExecutionTest, TheSecondSignalEndsThem) {
  add("a", 2);
  add("b", 1);
  std::size_t running = 0;
  runner_.on_start = [&](const JobStart& job) {
    running = job.number;
    runner_.events.emplace_back(StopAsked{1});
    runner_.events.emplace_back(StopAsked{2});
  };
  runner_.on_cancel_running = [&] { runner_.lose(running, true); };
  EXPECT_EQ(run(), (States{kNotRun, kNotRun}));
  EXPECT_EQ(runner_.running_cancelled, 1);
}

TEST_F(ExecutionTest, FailFastCancelsWhatHasNotBegun) {
  add("a", 2);
  add("b", 1);
  options_.fail_fast = true;
  runner_.on_start = [&](const JobStart& job) { runner_.answer(job.number, kFailed, "no"); };
  EXPECT_EQ(run(), (States{kFailed, kNotRun}));
  EXPECT_EQ(runner_.waiting_cancelled, 1);
}

TEST_F(ExecutionTest, NothingStartsThatWouldNotEndInTime) {
  add("a", 40);
  add("b", 30);
  options_.most_seconds = 60;
  runner_.on_start = [&](const JobStart& job) {
    now_ += 40;  // the second would end at 70
    runner_.answer(job.number, kDone);
  };
  EXPECT_EQ(run(), (States{kDone, kNotRun}));
}

TEST_F(ExecutionTest, ARunnerThatOrdersJobsIsGivenAllOfThem) {
  add("a", 1);
  add("b", 9, {0});
  add("c", 5, {1});
  runner_.orders = true;
  std::vector<JobStart> jobs;
  runner_.on_start = [&](const JobStart& job) {
    jobs.push_back(job);
    if (jobs.size() < 3) return;
    runner_.events.emplace_back(JobBegun{0});
    runner_.answer(0, kFailed, "no");
    // The second never ran: its input is not there.
    JobAnswered never{.number = 1, .outcome = {}};
    never.outcome.state = kFailed;
    runner_.events.emplace_back(never);
    runner_.lose(2, true);
  };
  EXPECT_EQ(run(), (States{kFailed, kSkipped, kNotRun}));
  EXPECT_EQ(runner_.started, (Names{"a", "b", "c"}));
  EXPECT_EQ(notes_.lines, (Names{"+a", "-a failed", "+b", "-b skipped"}));
}

TEST_F(ExecutionTest, NobodyNeedsToWait) {
  add("a");
  runner_.orders = true;
  runner_.is_waited_for = false;
  runner_.on_start = [&](const JobStart&) { runner_.say("submitted"); };
  EXPECT_EQ(run(), States{kNotRun});
  EXPECT_TRUE(has_said("submitted"));
}

TEST_F(ExecutionTest, WorkIsCounted) {
  add("a");
  runner_.on_start = [&](const JobStart& job) {
    runner_.events.emplace_back(WorkDone{30});
    JobAnswered answered{.number = job.number, .outcome = {}, .vertex_levels = 12};
    answered.outcome.state = kDone;
    answered.outcome.threads = 1;
    runner_.events.emplace_back(answered);
  };
  EXPECT_EQ(run(), States{kDone});
  EXPECT_EQ(vertex_levels_, 42);
}

// Or each of thousands of scans would fail over the same full disk.
TEST_F(ExecutionTest, APlaceThatCannotBeWrittenStopsTheRunAfterTheJobsUnderWay) {
  for (const int code : {ENOSPC, EDQUOT, EIO, EROFS, ENOENT}) {
    SCOPED_TRACE(code);
    plan_.clear();
    runner_ = {};
    for (const char* name : {"a", "b", "c", "d", "e"}) add(name);
    options_.total.cores = 3;
    runner_.on_start = [&](const JobStart& job) {
      const std::string& name = job.planned->job.name;
      name == "c" ? runner_.answer(job.number, kDone)
                  : runner_.refuse(job.number, code, name + ": cannot be written");
    };
    EXPECT_EQ(run(), (States{kNotRun, kNotRun, kDone, kNotRun, kNotRun}));
    EXPECT_EQ(runner_.started, (Names{"a", "b", "c"}));
    EXPECT_TRUE(has_said("stopping: a: cannot be written\n")) << said_;
    EXPECT_FALSE(has_said("failed")) << said_;
    EXPECT_FALSE(has_said("stopping: b")) << said_;
    EXPECT_EQ(outcomes_[0].write_error, code);
    EXPECT_EQ(outcomes_[0].error, "a: cannot be written");
    EXPECT_EQ(outcomes_[1].error, "");  // one sentence is enough
  }
}

TEST_F(ExecutionTest, AFileThatAloneCannotBeWrittenIsOneFailure) {
  for (const char* name : {"a", "b"}) add(name);
  runner_.on_start = [&](const JobStart& job) {
    job.number == 0 ? runner_.refuse(job.number, EFBIG, "a: too large")
                    : runner_.answer(job.number, kDone);
  };
  EXPECT_EQ(run(), (States{kFailed, kDone}));
  EXPECT_TRUE(has_said("failed: a: too large"));
}

}  // namespace
}  // namespace semigeo::jobs
