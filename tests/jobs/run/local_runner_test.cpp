#include "jobs/run/local_runner.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/scan_size.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/jobs/scans_to_run.hpp"
#include "tests/support/sanitizers.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_faults.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Notes what runs when.
class Notes : public JobListener {
 public:
  void job_started(const PlannedJob& planned) override {
    started.push_back(planned.job.name);
    most_running = std::max(most_running, ++running);
    if (on_start) on_start();
  }
  void job_ended(const PlannedJob&, const JobOutcome&) override { --running; }

  std::function<void()> on_start;
  std::vector<std::string> started;
  int running = 0;
  int most_running = 0;
};

class LocalRunnerTest : public testing::Test {
 protected:
  LocalRunnerTest() {
    fs::create_directories(folder_ / "in");
    config_.inputs = {folder_ / "in"};
    config_.archive = folder_ / "archive";
    config_.surface.levels = 1;
    options_.program = SEMIGEO_PROGRAM;
    options_.threads = 2;
  }
  std::vector<JobOutcome> run() {
    Progress progress(0, 0);
    options_.logs = config_.archive / "logs";
    listener_.started.clear();
    testing::internal::CaptureStderr();
    auto outcomes = run_jobs(plan_scans(config_), options_, progress, &listener_);
    said_ = testing::internal::GetCapturedStderr();
    vertex_levels_ = progress.vertex_levels();
    return outcomes;
  }
  std::vector<JobState> states() {
    std::vector<JobState> result;
    for (const JobOutcome& outcome : run()) result.push_back(outcome.state);
    return result;
  }
  void add(const char* name, const std::string& text) {
    std::ofstream(folder_ / "in" / name) << text;
  }
  void add(const char* name, const kernels::TriangleMesh& mesh) {
    tests::write_obj(folder_ / "in" / name, mesh);
  }

  tests::TemporaryFolder folder_;
  tests::ScansToRun config_;
  ExecutorOptions options_;
  Notes listener_;
  std::string said_;
  std::int64_t vertex_levels_ = 0;
};

const SurfaceJobResult* result_of(const JobOutcome& outcome) {
  return std::any_cast<SurfaceJobResult>(&outcome.result);
}

using States = std::vector<JobState>;
constexpr JobState kDone = JobState::kDone;
constexpr JobState kFailed = JobState::kFailed;
constexpr JobState kUpToDate = JobState::kUpToDate;
constexpr JobState kNotRun = JobState::kNotRun;

TEST_F(LocalRunnerTest, ABadScanFailsAlone) {
  add("a.obj", shapes::icosphere(2));
  add("b.obj", "v 0 0 0\nv 1 0 0\nf 1 2 7\n");
  add("c.obj", shapes::cube(1, 3));
  fs::create_symlink("gone", folder_ / "in/d.obj");
  add("e.obj", shapes::icosphere(1));
  const auto outcomes = run();
  ASSERT_EQ(outcomes.size(), 5u);
  for (const std::size_t i : {0u, 2u, 4u}) {
    EXPECT_EQ(outcomes[i].state, kDone) << i;
    EXPECT_TRUE(outcomes[i].error.empty());
    ASSERT_NE(result_of(outcomes[i]), nullptr);
    EXPECT_GE(outcomes[i].seconds, 0);
  }
  EXPECT_EQ(result_of(outcomes[0])->vertices, 162);
  EXPECT_EQ(result_of(outcomes[2])->vertices, 56);
  for (const std::size_t i : {1u, 3u}) {
    EXPECT_EQ(outcomes[i].state, kFailed) << i;
    EXPECT_FALSE(outcomes[i].result.has_value());
    const std::string file = (folder_ / (i == 1 ? "in/b.obj" : "in/d.obj")).string();
    EXPECT_TRUE(outcomes[i].error.starts_with(file)) << outcomes[i].error;
    EXPECT_NE(said_.find("failed: " + outcomes[i].error + "\n"), std::string::npos) << said_;
  }
  EXPECT_EQ(vertex_levels_, 2 * (162 + 56 + 42));
  for (const char* name : {"a.obj", "c.obj", "e.obj"})
    EXPECT_NO_THROW(
        io::Dataset(folder_ / "archive/scans" / (std::string(name) + ".vtkhdf")).verify());
  EXPECT_FALSE(fs::exists(folder_ / "archive/scans/b.obj.vtkhdf"));
}

TEST_F(LocalRunnerTest, WhatIsUpToDateIsLeftAlone) {
  add("a.obj", shapes::icosphere(1));
  add("b.obj", "v 0 0 0\n");
  EXPECT_EQ(states(), (States{kDone, kFailed}));
  EXPECT_EQ(states(), (States{kUpToDate, kFailed}));  // what failed is tried again
  EXPECT_EQ(vertex_levels_, 0);
  add("b.obj", shapes::icosphere(0));
  EXPECT_EQ(states(), (States{kUpToDate, kDone}));
  EXPECT_EQ(states(), (States{kUpToDate, kUpToDate}));
}

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(LocalRunnerTest, AMissingSidecarIsMadeFromTheDataset) {
  add("a.obj", shapes::icosphere(1));
  EXPECT_EQ(states(), States{kDone});
  const fs::path sidecar = config_.archive / "scans/a.obj.xdmf";
  const std::string text = bytes_of(sidecar);
  fs::remove(sidecar);
  EXPECT_EQ(states(), States{kDone});
  EXPECT_EQ(bytes_of(sidecar), text);
  EXPECT_EQ(vertex_levels_, 0);  // nothing was computed
  EXPECT_EQ(states(), States{kUpToDate});
}

/// The id of a process that has just ended.
pid_t dead_process() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

TEST_F(LocalRunnerTest, RemovesWhatAKilledRunLeft) {
  add("a.obj", shapes::icosphere(1));
  fs::create_directories(config_.archive / "scans");
  char host[256] = {};
  gethostname(host, sizeof host - 1);
  const fs::path stale =
      config_.archive / "scans" /
      (".a.obj.vtkhdf." + std::string(host) + "." + std::to_string(dead_process()) + ".partial");
  const fs::path foreign = config_.archive / "scans/.a.obj.vtkhdf.another-host.1.partial";
  for (const fs::path& file : {stale, foreign}) std::ofstream(file) << "half a dataset";
  EXPECT_EQ(states(), States{kDone});
  EXPECT_FALSE(fs::exists(stale));
  EXPECT_TRUE(fs::exists(foreign));
}

TEST_F(LocalRunnerTest, AnOutputThatCannotBeAFolderIsNamed) {
  add("a.obj", shapes::icosphere(0));
  std::ofstream(folder_ / "file") << "in the way";
  config_.archive = folder_ / "file";
  options_.logs = folder_ / "logs";
  Progress progress(0, 0);
  try {
    run_jobs(plan_scans(config_), options_, progress);
    ADD_FAILURE() << "it ran";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), folder_ / "file/scans");
  }
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class FaultTest : public LocalRunnerTest {
 protected:
  FaultTest() {
    for (const char* name : {"a.obj", "b.obj", "c.obj"}) add(name, shapes::icosphere(1));
    options_.retries = 0;
  }
  /// b failed, and says so; its neighbours are done, now or by a run before.
  std::string error_of_b() {
    const auto outcomes = run();
    if (outcomes.size() != 3) throw std::logic_error("three scans are planned");
    for (const std::size_t good : {0u, 2u})
      EXPECT_TRUE(outcomes[good].state == kDone || outcomes[good].state == kUpToDate) << good;
    const JobOutcome& bad = outcomes[1];
    EXPECT_EQ(bad.state, kFailed);
    EXPECT_FALSE(bad.result.has_value());
    EXPECT_EQ(bad.attempts, 1 + options_.retries);
    EXPECT_TRUE(bad.error.starts_with((folder_ / "in/b.obj").string() + ": ")) << bad.error;
    EXPECT_EQ(bad.error.find('\n'), std::string::npos) << bad.error;
    EXPECT_TRUE(holds(said_, "failed: " + bad.error + "\n")) << said_;
    EXPECT_FALSE(fs::exists(folder_ / "archive/scans/b.obj.vtkhdf"));
    return bad.error;
  }
  /// The same under a limit on time that no other job can reach, because the others are done
  /// before.
  std::string error_of_b_alone(const char* fault, double timeout_seconds) {
    {
      const tests::TestFaults crash("b.obj=crash");
      error_of_b();
    }
    const tests::TestFaults faults(fault);
    options_.timeout_seconds = timeout_seconds;
    return error_of_b();
  }
};

TEST_F(FaultTest, ACrashIsOneFailedJobWithItsLastWords) {
  const tests::TestFaults faults("b.obj=crash");
  const std::string error = error_of_b();
  EXPECT_TRUE(holds(error, "crashed (signal 11, Segmentation fault)")) << error;
  EXPECT_TRUE(holds(error, "it last said: about to crash;")) << error;
  EXPECT_TRUE(holds(error, (config_.archive / "logs/b.obj.log").string())) << error;
  EXPECT_EQ(bytes_of(config_.archive / "logs/b.obj.log"), "about to crash\n");
  // The next run's log is a new one.
  error_of_b();
  EXPECT_EQ(bytes_of(config_.archive / "logs/b.obj.log"), "about to crash\n");
}

TEST_F(FaultTest, WhatCrashesAlwaysIsTriedSoManyTimes) {
  const tests::TestFaults faults("b.obj=crash");
  options_.retries = 2;
  error_of_b();
  EXPECT_EQ(bytes_of(config_.archive / "logs/b.obj.log"),
            "about to crash\nabout to crash\nabout to crash\n");
  EXPECT_EQ(std::ranges::count(listener_.started, "b.obj"), 1);
}

TEST_F(FaultTest, WhatCrashesOnceIsDoneTheSecondTime) {
  const tests::TestFaults faults("b.obj=crash-once");
  options_.retries = 1;
  const auto outcomes = run();
  ASSERT_EQ(outcomes.size(), 3u);
  for (const JobOutcome& outcome : outcomes) EXPECT_EQ(outcome.state, kDone);
  EXPECT_EQ(outcomes[0].attempts, 1);
  EXPECT_EQ(outcomes[1].attempts, 2);
  EXPECT_EQ(outcomes[1].error, "");
  EXPECT_TRUE(holds(said_, "again: " + (folder_ / "in/b.obj").string() + ": crashed")) << said_;
}

TEST_F(FaultTest, AnEndlessLoopIsEnded) {
  const std::string error = error_of_b_alone("b.obj=loop", 1);
  EXPECT_TRUE(holds(error, "took longer than 1.0 s and was ended; run again")) << error;
}

TEST_F(FaultTest, AJobThatWaitsForEverIsEnded) {
  const std::string error = error_of_b_alone("b.obj=sleep", 1);
  EXPECT_TRUE(holds(error, "took longer than 1.0 s and was ended; run again")) << error;
}

TEST_F(FaultTest, AMemoryBombIsNotTriedAgain) {
  if (tests::kSanitized) GTEST_SKIP() << "the address space is not limited";
  const tests::TestFaults faults("b.obj=memory");
  options_.memory_per_job = std::uint64_t{600} << 20;
  const std::string error = error_of_b();
  EXPECT_TRUE(holds(error, "needs more than the 600 MiB of memory")) << error;
  options_.retries = 3;
  EXPECT_EQ(run()[1].attempts, 1);  // it would need as much again
}

TEST_F(FaultTest, AProgramThatIsNoWorkerFailsEachJob) {
  options_.program = "/bin/false";
  for (const JobOutcome& outcome : run()) {
    EXPECT_EQ(outcome.state, kFailed);
    EXPECT_TRUE(holds(outcome.error, "ended with exit code 1 instead of an answer"))
        << outcome.error;
  }
}

TEST_F(FaultTest, WhatCannotBeStartedFailsEachJob) {
  options_.program = folder_ / "gone";
  for (const JobOutcome& outcome : run()) {
    EXPECT_EQ(outcome.state, kFailed);
    EXPECT_TRUE(holds(outcome.error, "could not be started (cannot start " +
                                         options_.program.string() + ": No such file"))
        << outcome.error;
  }
}

TEST_F(FaultTest, AfterTheFirstSignalRunningJobsEndAndNoMoreStart) {
  options_.threads = 1;
  listener_.on_start = [] { raise(SIGTERM); };
  EXPECT_EQ(states(), (States{kDone, kNotRun, kNotRun}));
  EXPECT_TRUE(holds(said_, "stopping: 1 running jobs may end")) << said_;
  listener_.on_start = nullptr;
  EXPECT_EQ(states(), (States{kUpToDate, kDone, kDone}));
}

TEST_F(FaultTest, TheSecondSignalEndsWhatRuns) {
  const tests::TestFaults faults("a.obj=sleep");
  options_.threads = 1;
  options_.retries = 5;
  listener_.on_start = [] {
    raise(SIGINT);
    raise(SIGINT);
  };
  EXPECT_EQ(states(), (States{kNotRun, kNotRun, kNotRun}));
  EXPECT_FALSE(holds(said_, "failed")) << said_;
}

TEST_F(FaultTest, WhatCrashesWhileTheRunStopsHasFailed) {
  const tests::TestFaults faults("a.obj=crash");
  options_.threads = 1;
  options_.retries = 5;
  listener_.on_start = [] { raise(SIGINT); };
  const auto outcomes = run();
  EXPECT_EQ(outcomes[0].state, kFailed);
  EXPECT_EQ(outcomes[1].state, kNotRun);
}

TEST_F(LocalRunnerTest, FailFastStartsNothingAfterAFailure) {
  add("a.obj", "v 0 0 0\n" + std::string(10000, '\n'));  // by its size it takes longest
  add("b.obj", shapes::icosphere(1));
  add("c.obj", shapes::icosphere(1));
  options_.threads = 1;
  options_.fail_fast = true;
  EXPECT_EQ(states(), (States{kFailed, kNotRun, kNotRun}));
  EXPECT_EQ(listener_.started, std::vector<std::string>{"a.obj"});
  options_.fail_fast = false;
  EXPECT_EQ(states(), (States{kFailed, kDone, kDone}));
}

TEST_F(LocalRunnerTest, FailFastStartsNothingWhenAScanCannotBeRead) {
  fs::create_symlink("gone", folder_ / "in/a.obj");
  add("b.obj", shapes::icosphere(1));
  options_.fail_fast = true;
  EXPECT_EQ(states(), (States{kFailed, kNotRun}));
}

TEST_F(LocalRunnerTest, StartsNothingThatWillNotEndInTime) {
  add("a.obj", shapes::icosphere(1));
  add("b.obj", shapes::icosphere(2));
  options_.most_seconds = 1e-3;
  EXPECT_EQ(states(), (States{kNotRun, kNotRun}));
  EXPECT_TRUE(listener_.started.empty());
  options_.most_seconds = 3600;
  EXPECT_EQ(states(), (States{kDone, kDone}));
}

TEST_F(LocalRunnerTest, TimeThatIsTooShortForALongJobIsUsedForAShortOne) {
  add("a.obj", shapes::icosphere(1));
  add("b.obj", shapes::icosphere(3) /* 40 kB */);
  Estimates::Rates slow;
  slow.microseconds = 100;
  const auto seconds = [&](const char* name) {
    return Estimates({}, slow).of(scan_size(folder_ / "in" / name), 2, 1).seconds;
  };
  slow.microseconds = 5 / seconds("a.obj") * 100;  // now some 5 s, beside which planning is nothing
  options_.estimates = Estimates({}, slow);
  options_.threads = 1;
  ASSERT_LT(2 * seconds("a.obj"), seconds("b.obj"));
  options_.most_seconds = 2 * seconds("a.obj");
  EXPECT_EQ(states(), (States{kDone, kNotRun}));
}

TEST_F(LocalRunnerTest, RunsSideBySideWhatMemoryAdmits) {
  for (const char* name : {"a.obj", "b.obj", "c.obj", "d.obj"}) add(name, shapes::icosphere(1));
  options_.memory_bytes = std::uint64_t{1} << 40;
  EXPECT_EQ(states(), (States{kDone, kDone, kDone, kDone}));
  EXPECT_EQ(listener_.most_running, 2);  // as there are threads
  fs::remove_all(config_.archive / "scans");
  listener_.most_running = 0;
  options_.memory_bytes = std::uint64_t{1} << 20;  // less than any needs: then one by one
  EXPECT_EQ(states(), (States{kDone, kDone, kDone, kDone}));
  EXPECT_EQ(listener_.most_running, 1);
}

TEST_F(LocalRunnerTest, TheLongestGoFirst) {
  add("a.obj", shapes::icosphere(0));
  add("b.obj", shapes::icosphere(2));
  add("c.obj", shapes::icosphere(1));
  options_.threads = 1;
  EXPECT_EQ(states(), (States{kDone, kDone, kDone}));
  EXPECT_EQ(listener_.started, (std::vector<std::string>{"b.obj", "c.obj", "a.obj"}));
}

TEST_F(LocalRunnerTest, ThreadsGoToWhatWouldRunAlone) {
  add("large.obj", shapes::icosphere(5));
  options_.threads = 2;
  EXPECT_EQ(run()[0].threads, 2);
  const std::string alone = bytes_of(config_.archive / "scans/large.obj.vtkhdf");
  fs::remove_all(config_.archive / "scans");
  for (const char* name : {"a.obj", "b.obj", "c.obj"}) add(name, shapes::icosphere(5));
  const auto outcomes = run();
  ASSERT_EQ(outcomes.size(), 4u);
  EXPECT_EQ(outcomes[0].threads, 1);
  EXPECT_EQ(bytes_of(config_.archive / "scans/large.obj.vtkhdf"), alone);
}

TEST_F(LocalRunnerTest, NothingToDoIsNoError) {
  add("a.txt", "no scan");
  EXPECT_TRUE(run().empty());
}

}  // namespace
}  // namespace semigeo::jobs
