#include "jobs/slurm/slurm_commands.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace semigeo::jobs {
namespace {

bool has(const std::vector<std::string>& arguments, const std::string& wanted) {
  return std::ranges::find(arguments, wanted) != arguments.end();
}

TEST(SlurmCommandsTest, SbatchIsAskedForEnough) {
  const auto arguments = sbatch_arguments({.name = "semigeo-surface",
                                           .script = "/a/s.sh",
                                           .folder = "/a",
                                           .tasks = 8,
                                           .cpus = 2,
                                           .memory_bytes = (std::uint64_t{1} << 30) + 1,
                                           .seconds = 61,
                                           .options = {"account=geo", "-plong"}});
  for (const char* wanted : {"--parsable", "--array=0-7", "--cpus-per-task=2", "--mem=1025M",
                             "--time=2", "--chdir=/a", "--output=task-%a.log"})
    EXPECT_TRUE(has(arguments, wanted)) << wanted;
  EXPECT_FALSE(std::ranges::any_of(
      arguments, [](const std::string& a) { return a.starts_with("--dependency"); }));
  // What is passed on stands behind ours, so that it holds.
  EXPECT_EQ(std::vector<std::string>(arguments.end() - 3, arguments.end()),
            (std::vector<std::string>{"--account=geo", "-plong", "/a/s.sh"}));
}

TEST(SlurmCommandsTest, AStageWaitsForThoseBefore) {
  const auto arguments =
      sbatch_arguments({.name = "n", .script = "/s", .folder = "/", .after = {"12", "34"}});
  EXPECT_TRUE(has(arguments, "--dependency=afterok:12:34"));
  EXPECT_TRUE(has(arguments, "--kill-on-invalid-dep=yes"));
  EXPECT_FALSE(
      std::ranges::any_of(arguments, [](const std::string& a) { return a.starts_with("--mem"); }));
}

TEST(SlurmCommandsTest, TheQueueIsReadByNumberAndState) {
  using State = QueuedTask::State;
  const auto tasks = parse_queue(
      "0 RUNNING None\n1 COMPLETING None\n2 PENDING Resources\n3 CONFIGURING\n"
      "4 SUSPENDED None\nslurm: warning: something\nN/A PENDING None\n\n5");
  EXPECT_EQ(tasks, (std::map<int, QueuedTask>{{0, {State::kRunning}},
                                              {2, {State::kPending, "Resources"}},
                                              {3, {State::kPending}},
                                              {4, {State::kRunning}}}));
  EXPECT_TRUE(parse_queue("").empty());
}

}  // namespace
}  // namespace semigeo::jobs
