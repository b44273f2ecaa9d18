#include "jobs/slurm/slurm_stage.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "jobs/kinds/all_kinds.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/slurm/task_list.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMegabyte = 1'000'000;

class SlurmStageTest : public testing::Test {
 protected:
  SlurmStageTest() {
    fs::create_directories(folders_.run);
    options_.program = "/opt/it's/semigeo";
  }
  /// A scan of so many bytes, of which only the size counts.
  void add(const std::string& name, std::uint64_t bytes) {
    PlannedJob& planned = plan_.emplace_back();
    planned.job.kind = &surface_kind();
    planned.job.data = SurfaceJobData{};
    planned.job.name = name;
    planned.job.input = folder_ / name;
    planned.job.output = folders_.archive / "scans" / (name + ".vtkhdf");
    std::ofstream(planned.job.input) << "ply\nformat binary_little_endian 1.0\n";
    fs::resize_file(planned.job.input, bytes);
    jobs_.push_back(plan_.size() - 1);
  }
  SlurmStage stage() const { return stages_of(plan_, jobs_, options_, slurm_, folders_).front(); }
  Estimate estimate(std::size_t job) const {
    return options_.estimates.of(
        {.format = "PLY binary", .bytes = fs::file_size(plan_[job].job.input)},
        SurfaceParameters{}.levels + 1, 1);
  }

  tests::TemporaryFolder folder_;
  SlurmFolders folders_ = {.archive = folder_ / "archive", .run = folder_ / "archive/slurm/run"};
  std::vector<PlannedJob> plan_;
  std::vector<std::size_t> jobs_;
  ExecutorOptions options_;
  SlurmOptions slurm_;
};

TEST_F(SlurmStageTest, AsksForWhatTheLargestTaskNeeds) {
  add("small.ply", kMegabyte);
  add("large.ply", 100 * kMegabyte);
  add("other.ply", kMegabyte);
  slurm_.scans_per_task = 2;
  const SlurmStage made = stage();
  EXPECT_EQ(made.tasks, (std::vector<std::vector<std::size_t>>{{1, 0}, {2}}));
  EXPECT_EQ(made.array.tasks, 2);
  EXPECT_EQ(made.array.cpus, 1);
  EXPECT_GT(static_cast<double>(made.array.memory_bytes), 1.4 * estimate(1).peak_bytes);
  EXPECT_LT(static_cast<double>(made.array.memory_bytes), 2 * estimate(1).peak_bytes + 1e9);
  const Task task = read_task(made.list, 0, all_kinds());
  ASSERT_EQ(task.jobs.size(), 2u);
  EXPECT_EQ(task.jobs[0].job.name, "large.ply");
  EXPECT_LT(task.settings.memory_bytes, made.array.memory_bytes);
  // Even if its scan hangs as often as it may, the others have their time.
  EXPECT_GT(made.array.seconds,
            2 * task.settings.timeout_seconds + estimate(0).seconds + estimate(1).seconds);
  EXPECT_GT(task.settings.timeout_seconds, 5 * estimate(1).seconds);
}

TEST_F(SlurmStageTest, WhatTheUserSaysHolds) {
  add("a.ply", kMegabyte);
  options_.threads = 3;
  options_.memory_bytes = std::uint64_t{7} << 30;
  options_.memory_per_job = 17 * kMegabyte;
  options_.timeout_seconds = 5000;
  options_.retries = 0;
  options_.fail_fast = true;
  const SlurmStage made = stage();
  EXPECT_EQ(made.array.cpus, 3);
  EXPECT_EQ(made.array.memory_bytes, options_.memory_bytes);
  EXPECT_GT(made.array.seconds, 5000);
  EXPECT_LT(made.array.seconds, 5100);
  const Task task = read_task(made.list, 0, all_kinds());
  EXPECT_EQ(task.settings.threads, 3);
  EXPECT_EQ(task.settings.retries, 0);
  EXPECT_TRUE(task.settings.fail_fast);
  EXPECT_EQ(task.settings.deadline, 0);
  EXPECT_EQ(task.jobs[0].address_space_bytes, options_.memory_per_job);
}

TEST_F(SlurmStageTest, EachKindIsAStageThatWaitsForThoseBeforeIt) {
  add("a.ply", kMegabyte);
  add("b.ply", 50 * kMegabyte);
  const auto more = [&](Job job, std::vector<std::size_t> after) {
    PlannedJob planned;
    planned.job = std::move(job);
    planned.after = std::move(after);
    jobs_.push_back(plan_.size());
    plan_.push_back(planned);
  };
  const std::vector<std::string> models = {"a.ply", "b.ply"};
  more(triplets_job("a.ply", folder_ / "none", "k", folder_.path(), {}), {0});
  more(triplets_job("b.ply", folder_ / "none", "k", folder_.path(), {}), {1});
  more(partition_job(0, {.models = models}, folder_.path(), {}), {2, 3});
  more(library_job({.models = models}, folder_ / "library.h5", folder_.path(), {}), {4});
  plan_[0].up_to_date = true;
  jobs_.erase(jobs_.begin());
  const auto stages = stages_of(plan_, jobs_, options_, slurm_, folders_);
  ASSERT_EQ(stages.size(), 4u);
  EXPECT_EQ(stages[0].array.name, "semigeo-surface");
  EXPECT_EQ(stages[1].array.name, "semigeo-triplets");
  EXPECT_EQ(stages[3].array.name, "semigeo-library");
  EXPECT_EQ(stages[0].after, std::vector<std::size_t>{});
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(stages[i].after, std::vector{i - 1});
  // Before its dataset is there, a triplets job is judged by the scan.
  EXPECT_GT(stages[1].array.memory_bytes, 500 * kMegabyte);
  EXPECT_GT(stages[3].array.memory_bytes, 256 * kMegabyte);
  const Task task = read_task(stages[2].list, 0, all_kinds());
  EXPECT_EQ(task.jobs[0].job.kind, &partition_kind());
  EXPECT_EQ(partition_kind().data_to_json(task.jobs[0].job).at("models"), models);
}

TEST_F(SlurmStageTest, TheScriptIsOfQuotedWords) {
  add("a.ply", kMegabyte);
  std::ifstream script(stage().array.script);
  const std::string text{std::istreambuf_iterator<char>(script), {}};
  EXPECT_EQ(text, "#!/bin/sh\nexec '/opt/it'\\''s/semigeo' job --list '" +
                      (folders_.run / "surface/tasks.jsonl").string() +
                      "' --task \"$SLURM_ARRAY_TASK_ID\"\n");
}

}  // namespace
}  // namespace semigeo::jobs
