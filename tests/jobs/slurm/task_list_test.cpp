#include "jobs/slurm/task_list.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <numeric>

#include "io/files/error.hpp"
#include "tests/jobs/written_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Tasks = std::vector<std::vector<std::size_t>>;

TEST(TaskListTest, TasksLastFiveMinutesAndTheLongestJobsComeFirst) {
  EXPECT_EQ(share_out(std::vector<double>{100, 1000, 50, 250, 60}, 0),
            (Tasks{{1}, {3}, {0, 4, 2}}));
  EXPECT_EQ(share_out(std::vector<double>{1, 2, 3}, 0), (Tasks{{2, 1, 0}}));
  EXPECT_TRUE(share_out({}, 0).empty());
}

TEST(TaskListTest, AsManyJobsInATaskAsAskedFor) {
  EXPECT_EQ(share_out(std::vector<double>{1, 3, 2, 3, 9}, 2), (Tasks{{4, 1}, {3, 2}, {0}}));
  EXPECT_EQ(share_out(std::vector<double>{1000, 1000}, 5), (Tasks{{0, 1}}));
}

TEST(TaskListTest, AreAtMostTenThousandHoweverLong) {
  const std::vector<double> seconds(30'000, 290);
  const Tasks tasks = share_out(seconds, 0);
  EXPECT_LE(tasks.size(), 10'000u);
  EXPECT_GT(tasks.size(), 5'000u);
  std::vector<bool> seen(seconds.size());
  for (const auto& task : tasks)
    for (const std::size_t job : task) {
      EXPECT_FALSE(seen[job]);
      seen[job] = true;
    }
  EXPECT_EQ(std::accumulate(seen.begin(), seen.end(), 0), 30'000);
}

const JobKinds kKinds({&tests::text_kind()});

JobRequest request(const std::string& name) {
  JobRequest request;
  request.job = tests::text_job(name, "/in", {.text = "three"}).job;
  request.job.input = "/in/\xff" + name;
  request.job.output = "/archive/scans/" + name + ".vtkhdf";
  request.job.key = "key of " + name;
  request.threads = 2;
  request.log = "/archive/logs/" + name + ".log";
  return request;
}

class TaskFileTest : public testing::Test {
 protected:
  fs::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(TaskFileTest, ATaskFindsItsJobs) {
  const TaskSettings settings{.archive = "/arch\xff",
                              .threads = 2,
                              .memory_bytes = std::uint64_t{1} << 40,
                              .timeout_seconds = 1.5,
                              .retries = 3,
                              .fail_fast = true,
                              .deadline = 1.75e9};
  std::vector<std::vector<JobRequest>> tasks;
  for (int i = 0; i < 12; ++i)
    tasks.push_back({request("a" + std::to_string(i)), request("b" + std::to_string(i))});
  const fs::path list = write("tasks.jsonl", task_list_text(settings, tasks));
  for (const int number : {0, 1, 11}) {
    const Task task = read_task(list, number, kKinds);
    EXPECT_EQ(task.settings, settings);
    ASSERT_EQ(task.jobs.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_EQ(to_line(task.jobs[i]), to_line(tasks[static_cast<std::size_t>(number)][i]));
  }
}

TEST_F(TaskFileTest, AListThatIsMissingOrDamagedIsAnErrorThatSaysWhere) {
  EXPECT_THROW(read_task(folder_ / "none", 0, kKinds), io::Error);
  const std::string text = task_list_text({}, {{request("a")}, {request("b")}});
  EXPECT_THROW(read_task(write("list", text), 2, kKinds), io::Error);
  try {
    read_task(write("torn", text.substr(0, text.size() - 20)), 1, kKinds);
    ADD_FAILURE() << "half a line was read";
  } catch (const io::Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 3"), std::string::npos) << error.what();
  }
}

TEST_F(TaskFileTest, ResultsComeBackAndDamagedLinesAreNone) {
  TaskResults results;
  results["a \"quoted\""].result = {{"letters", 17}};
  JobOutcome& done = results["a \"quoted\""].outcome;
  done.state = JobState::kDone;
  done.seconds = 2.5;
  done.cpu_seconds = 2;
  done.peak_bytes = 1e9;
  done.threads = 2;
  done.attempts = 1;
  JobOutcome& failed = results["b"].outcome;
  failed.state = JobState::kFailed;
  failed.error = "b.ply: is no scan";
  results["c"].outcome.state = JobState::kNotRun;
  JobOutcome& stopped = results["d"].outcome;
  stopped.state = JobState::kNotRun;
  stopped.error = "d.vtkhdf: cannot be written";
  stopped.write_error = ENOSPC;
  const std::string text = results_text(results);
  const TaskResults read = read_results(write("results", text + "{\"name\":\"e\""));
  ASSERT_EQ(read.size(), 4u);
  const JobOutcome& a = read.at("a \"quoted\"").outcome;
  EXPECT_EQ(a.state, JobState::kDone);
  EXPECT_EQ(read.at("a \"quoted\"").result.at("letters"), 17);
  EXPECT_EQ(a.seconds, 2.5);
  EXPECT_EQ(a.cpu_seconds, 2);
  EXPECT_EQ(a.peak_bytes, 1e9);
  EXPECT_EQ(a.threads, 2);
  EXPECT_EQ(a.attempts, 1);
  EXPECT_EQ(read.at("b").outcome.state, JobState::kFailed);
  EXPECT_EQ(read.at("b").outcome.error, failed.error);
  EXPECT_EQ(read.at("c").outcome.state, JobState::kNotRun);
  EXPECT_EQ(read.at("d").outcome.state, JobState::kFailed) << "the run stops at it, too";
  EXPECT_EQ(read.at("d").outcome.error, stopped.error);
  EXPECT_EQ(read.at("d").outcome.write_error, ENOSPC);
  EXPECT_TRUE(read_results(folder_ / "none").empty());
}

}  // namespace
}  // namespace semigeo::jobs
