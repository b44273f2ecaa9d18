#include "jobs/local_executor.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "io/dataset.hpp"
#include "io/error.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class LocalExecutorTest : public testing::Test {
 protected:
  LocalExecutorTest() {
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
    testing::internal::CaptureStderr();
    auto outcomes = run_jobs(plan_jobs(config_), config_.surface, options_, progress);
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
  RunConfig config_;
  ExecutorOptions options_;
  std::string said_;
  std::int64_t vertex_levels_ = 0;
};

using States = std::vector<JobState>;
constexpr JobState kDone = JobState::kDone;
constexpr JobState kFailed = JobState::kFailed;
constexpr JobState kUpToDate = JobState::kUpToDate;

TEST_F(LocalExecutorTest, ABadScanFailsAlone) {
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
    ASSERT_TRUE(outcomes[i].result.has_value());
    EXPECT_GE(outcomes[i].seconds, 0);
  }
  EXPECT_EQ(outcomes[0].result->vertices, 162);
  EXPECT_EQ(outcomes[2].result->vertices, 56);
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

TEST_F(LocalExecutorTest, WhatIsUpToDateIsLeftAlone) {
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

TEST_F(LocalExecutorTest, AMissingSidecarIsMadeFromTheDataset) {
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

TEST_F(LocalExecutorTest, RemovesWhatAKilledRunLeft) {
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

TEST_F(LocalExecutorTest, AnOutputThatCannotBeAFolderIsNamed) {
  add("a.obj", shapes::icosphere(0));
  std::ofstream(folder_ / "file") << "in the way";
  config_.archive = folder_ / "file";
  options_.logs = folder_ / "logs";
  Progress progress(0, 0);
  try {
    run_jobs(plan_jobs(config_), config_.surface, options_, progress);
    ADD_FAILURE() << "it ran";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), folder_ / "file/scans");
  }
}

TEST_F(LocalExecutorTest, NothingToDoIsNoError) {
  add("a.txt", "no scan");
  EXPECT_TRUE(run().empty());
}

}  // namespace
}  // namespace semigeo::jobs
