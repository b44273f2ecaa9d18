#include "jobs/run/run.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/files/error.hpp"
#include "jobs/archive/archive_lock.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/archive/status.hpp"
#include "tests/jobs/run/fake_runner.hpp"
#include "tests/jobs/written_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using enum JobState;

class RunTest : public testing::Test {
 protected:
  RunTest() {
    settings_.home = folder_ / "home";
    settings_.program_version = "7";
    hooks_.plan = [this](DigestCache&) {
      order_.push_back("plan");
      std::vector<PlannedJob> plan;
      for (const std::string& name : names_)
        plan.push_back(tests::text_job(name, folder_.path(), {.text = name, .seconds = 1}));
      return plan;
    };
    hooks_.prepare = [this](const std::vector<PlannedJob>&) { order_.push_back("prepare"); };
    hooks_.planned = [this](const std::vector<PlannedJob>&) { order_.push_back("planned"); };
    hooks_.runner = [this](const std::vector<PlannedJob>&) -> Runner& {
      order_.push_back("runner");
      return runner_;
    };
    hooks_.settings = [] { return ExecutionSettings{.total = {.cores = 1, .bytes = 1000}}; };
    hooks_.warn = [this](const std::string& what) { warnings_.push_back(what); };
  }
  RunResult run() {
    testing::internal::CaptureStderr();
    struct Release {
      ~Release() { testing::internal::GetCapturedStderr(); }
    } release;
    return perform_run(settings_, hooks_, [this] { return now_; });
  }
  std::vector<std::string> journal() {
    std::vector<std::string> events;
    read_journal(settings_.home, [&](const JournalEntry& entry) {
      if (const auto* started = std::get_if<JobStarted>(&entry.event))
        events.push_back("+" + started->job);
      if (const auto* ended = std::get_if<JobEnded>(&entry.event))
        events.push_back("-" + ended->job + " " + ended->state);
      if (std::holds_alternative<RunStarted>(entry.event)) events.emplace_back("run");
      if (std::holds_alternative<RunEnded>(entry.event)) events.emplace_back("end");
    });
    return events;
  }

  tests::TemporaryFolder folder_;
  std::vector<std::string> names_ = {"a", "b"};
  RunSettings settings_;
  RunHooks hooks_;
  tests::FakeRunner runner_;
  double now_ = 0;
  std::vector<std::string> order_;
  std::vector<std::string> warnings_;
};

using Lines = std::vector<std::string>;

TEST_F(RunTest, LocksPlansJournalsAndExecutesInThisOrder) {
  bool locked_while_running = false;
  runner_.on_start = [&](const JobStart& job) {
    order_.push_back("start");
    locked_while_running = fs::exists(settings_.home / "journal.jsonl");
    EXPECT_THROW(ArchiveLock second(settings_.home), LockedError);
    now_ += 2;
    runner_.answer(job.number, kDone);
  };
  const RunResult result = run();
  EXPECT_EQ(order_, (Lines{"plan", "prepare", "planned", "runner", "start", "start"}));
  EXPECT_TRUE(locked_while_running);
  EXPECT_EQ(result.summary.done, 2);
  EXPECT_EQ(result.summary.wall_seconds, 4);
  EXPECT_EQ(journal(), (Lines{"run", "+text a", "-text a done", "+text b", "-text b done", "end"}));
  EXPECT_NO_THROW(ArchiveLock(settings_.home));  // it was given back
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(RunTest, TheJournalIsToldOnceOfAJobThatFailedAndIsUpToDateNow) {
  runner_.on_start = [&](const JobStart& job) {
    runner_.answer(job.number, job.planned->job.name == "a" ? kFailed : kDone);
  };
  run();
  for (const std::string& name : names_) std::ofstream(folder_ / name) << "key of " << name << '\n';
  const Lines before = journal();
  EXPECT_EQ(run().summary.up_to_date, 2);
  Lines wanted = before;
  wanted.insert(wanted.end(), {"run", "-text a up to date", "end"});
  EXPECT_EQ(journal(), wanted);
  EXPECT_EQ(status_of(settings_.home).up_to_date, 2);
  EXPECT_EQ(status_of(settings_.home).left(), 0);
  run();
  wanted.insert(wanted.end(), {"run", "end"});
  EXPECT_EQ(journal(), wanted);
  EXPECT_EQ(status_of(settings_.home).up_to_date, 2);
}

TEST_F(RunTest, FoldersThatAreLinksAreRefusedBeforeAnythingIsWritten) {
  fs::create_directories(settings_.home);
  fs::create_directories(folder_ / "elsewhere");
  for (const char* name : {"scans", "logs", "recognised"}) {
    fs::create_directory_symlink(folder_ / "elsewhere", settings_.home / name);
    EXPECT_THROW(run(), io::Error) << name;
    EXPECT_TRUE(journal().empty());
    fs::remove(settings_.home / name);
  }
  EXPECT_TRUE(fs::is_empty(folder_ / "elsewhere"));
}

TEST_F(RunTest, TheHomeIsLockedUntilTheResultIsTold) {
  bool told = false;
  hooks_.ended = [&](const RunResult& result) {
    told = true;
    EXPECT_EQ(result.summary.done, 2);
    EXPECT_EQ(journal().back(), "end");
    EXPECT_THROW(ArchiveLock second(settings_.home), LockedError);
  };
  run();
  EXPECT_TRUE(told);
}

TEST_F(RunTest, AnotherRunHasTheHome) {
  fs::create_directories(settings_.home);
  const ArchiveLock other(settings_.home);
  EXPECT_THROW(run(), LockedError);
  EXPECT_TRUE(order_.empty());
}

TEST_F(RunTest, WhatCannotBeWrittenFailsOnlyIfJobsHaveToRun) {
  settings_.home = folder_ / "file" / "home";  // below a file: nobody can make it, not even root
  std::ofstream(folder_ / "file") << "no folder";
  EXPECT_THROW(run(), io::Error);
  EXPECT_EQ(order_, Lines{"plan"});
  for (const std::string& name : names_) std::ofstream(folder_ / name) << "key of " << name << '\n';
  const RunResult result = run();
  EXPECT_EQ(result.summary.up_to_date, 2);
  EXPECT_EQ(result.outcomes[1].state, kUpToDate);
  EXPECT_TRUE(runner_.started.empty());
}

TEST_F(RunTest, AHomeThatIsNotKeptHasNeitherLockNorJournal) {
  settings_.is_kept = false;
  EXPECT_EQ(run().summary.done, 2);
  EXPECT_FALSE(fs::exists(settings_.home / "journal.jsonl"));
  EXPECT_EQ(order_.front(), "plan");
}

TEST_F(RunTest, CountsWhatHasBecomeOfJobs) {
  names_ = {"a", "b", "c", "d"};
  std::ofstream(folder_ / "d") << "key of d\n";
  runner_.on_start = [&](const JobStart& job) {
    if (job.number == 0) return runner_.answer(job.number, kFailed, "no");
    runner_.events.emplace_back(StopAsked{1});
    runner_.answer(job.number, kDone);
  };
  const RunSummary summary = run().summary;
  EXPECT_EQ(summary.failed, 1);
  EXPECT_EQ(summary.done, 1);
  EXPECT_EQ(summary.not_run, 1);
  EXPECT_EQ(summary.up_to_date, 1);
}

TEST_F(RunTest, RemovesWhatKilledWritersAndRunsHaveLeft) {
  fs::create_directories(settings_.home / "logs");
  std::ofstream(settings_.home / "logs/empty.log");
  std::ofstream(settings_.home / "logs/full.log") << "words";
  run();
  EXPECT_FALSE(fs::exists(settings_.home / "logs/empty.log"));
  EXPECT_TRUE(fs::exists(settings_.home / "logs/full.log"));
}

TEST_F(RunTest, WarnsOfAJournalThatCannotBeWritten) {
  fs::create_directories(settings_.home / "journal.jsonl");
  EXPECT_EQ(run().summary.done, 2);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("journal.jsonl"), std::string::npos) << warnings_[0];
}

}  // namespace
}  // namespace semigeo::jobs
