#include "jobs/kinds/surface_plan.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "engine/run_context.hpp"
#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/kinds/surface.hpp"
#include "tests/jobs/scans_to_run.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

class SurfacePlanTest : public testing::Test {
 protected:
  SurfacePlanTest() {
    fs::create_directories(folder_ / "in");
    fs::create_directories(folder_ / "archive/scans");
    tests::write_obj(folder_ / "in/a.obj", shapes::icosphere(1));
    tests::write_obj(folder_ / "in/b.obj", shapes::cube(1, 2));
    config_.inputs = {folder_ / "in"};
    config_.archive = folder_ / "archive";
    config_.surface.levels = 1;
  }
  void run_all() {
    const auto plan = plan_scans(config_);
    fs::create_directories(folder_ / "archive/scans");
    record_sources(config_.archive, plan);
    for (const PlannedJob& planned : plan)
      if (!planned.up_to_date) planned.job.kind->run(planned.job, {context_});
  }
  /// The reasons why jobs run, "" for those that do not.
  Names reasons() {
    Names result;
    for (const PlannedJob& planned : plan_scans(config_)) {
      EXPECT_EQ(planned.up_to_date, planned.reasons.empty() && planned.error.empty());
      result.push_back(planned.error.empty() ? in_short(planned.reasons) : planned.error);
    }
    return result;
  }

  tests::TemporaryFolder folder_;
  tests::ScansToRun config_;
  engine::Workers workers_{1};
  engine::Observer observer_;
  engine::RunContext context_{workers_, observer_, {}};
};

const Names kBothUpToDate = {"", ""};
constexpr const char* kMissing = "no dataset yet";
constexpr const char* kDamaged = "the dataset is damaged, incomplete or of another format";

TEST_F(SurfacePlanTest, DescribesEachJob) {
  const auto plan = plan_scans(config_);
  ASSERT_EQ(plan.size(), 2u);
  const Job& job = plan[0].job;
  EXPECT_EQ(job.input, folder_ / "in/a.obj");
  EXPECT_EQ(job.name, "a.obj");
  EXPECT_EQ(job.output, folder_ / "archive/scans/a.obj.vtkhdf");
  EXPECT_EQ(surface_data(job).input_xxh3, io::xxh3_of_file(folder_ / "in/a.obj"));
  EXPECT_EQ(job.key, surface_key("a.obj", surface_data(job).input_xxh3, to_json(config_.surface)));
}

TEST_F(SurfacePlanTest, WhatWasRunIsUpToDate) {
  EXPECT_EQ(reasons(), (Names{kMissing, kMissing}));
  run_all();
  EXPECT_EQ(reasons(), kBothUpToDate);
}

TEST_F(SurfacePlanTest, TimesAndThreadsDoNotMatter) {
  run_all();
  config_.threads = 7;
  for (const char* file : {"in/a.obj", "archive/scans/b.obj.vtkhdf"}) {
    const timespec times[] = {{1'000'000'000, 0}, {1'000'000'000, 0}};
    ASSERT_EQ(utimensat(AT_FDCWD, (folder_ / file).c_str(), times, 0), 0);
  }
  // The same bytes in another file, at another place.
  fs::copy(folder_ / "in", folder_ / "moved");
  config_.inputs = {folder_ / "moved"};
  EXPECT_EQ(reasons(), kBothUpToDate);
}

TEST_F(SurfacePlanTest, AChangedScanIsRunAlone) {
  run_all();
  const auto time = fs::last_write_time(folder_ / "in/b.obj");
  std::ofstream(folder_ / "in/b.obj", std::ios::app) << "# changed\n";
  fs::last_write_time(folder_ / "in/b.obj", time);
  EXPECT_EQ(reasons(), (Names{"", "the scan changed"}));
  run_all();
  EXPECT_EQ(reasons(), kBothUpToDate);
}

TEST_F(SurfacePlanTest, AChangedParameterRunsAll) {
  run_all();
  config_.surface.evolution.step_factor = 1.5;
  EXPECT_EQ(reasons(), (Names{"the parameters changed", "the parameters changed"}));
  config_.surface.evolution.step_factor = 1;
  EXPECT_EQ(reasons(), kBothUpToDate);
}

TEST_F(SurfacePlanTest, NamesWhatDiffers) {
  const std::string before = surface_data(plan_scans(config_)[1].job).input_xxh3;
  run_all();
  config_.surface.evolution.step_factor = 1.5;
  config_.surface.levels = 2;
  tests::write_obj(folder_ / "in/b.obj", shapes::cube(1, 3));
  const auto plan = plan_scans(config_);
  const Reason levels{
      .kind = Reason::Kind::kParameter, .parameter = "levels", .before = 1, .now = 2};
  const Reason step{
      .kind = Reason::Kind::kParameter, .parameter = "step", .before = 1.0, .now = 1.5};
  const Reason scan{
      .kind = Reason::Kind::kScan, .before = before, .now = surface_data(plan[1].job).input_xxh3};
  EXPECT_EQ(plan[0].reasons, (std::vector<Reason>{levels, step}));
  EXPECT_EQ(plan[1].reasons, (std::vector<Reason>{scan, levels, step}));
}

TEST_F(SurfacePlanTest, AProgramThatComputedSomethingElseIsToldFromOtherParameters) {
  for (PlannedJob& planned : plan_scans(config_)) {
    planned.job.key = "key of another version";
    planned.job.kind->run(planned.job, {context_});
  }
  EXPECT_EQ(reasons(), (Names{"the program changed", "the program changed"}));
  config_.surface.levels = 2;
  EXPECT_EQ(reasons(), (Names{"the parameters and the program changed",
                              "the parameters and the program changed"}));
}

TEST_F(SurfacePlanTest, ACacheChangesNothingButTheReading) {
  run_all();
  const auto scans = find_scans(config_.inputs, config_.archive).scans;
  const auto with_cache = [&] {
    DigestCache cache = DigestCache::read(config_.archive, [] {
      return DigestCache::system_clock() + std::int64_t{3600} * 1'000'000'000;
    });
    Names found;
    for (const PlannedJob& planned :
         plan_surfaces(config_.archive, scans, config_.surface, cache, 0))
      found.push_back(in_short(planned.reasons));
    cache.write();
    return found;
  };
  for (int i = 0; i < 2; ++i) EXPECT_EQ(with_cache(), kBothUpToDate);
  config_.surface.levels = 2;
  EXPECT_EQ(with_cache(), (Names{"the parameters changed", "the parameters changed"}));
  config_.surface.levels = 1;
  const auto time = fs::last_write_time(folder_ / "in/b.obj");
  {
    std::fstream file(folder_ / "in/b.obj", std::ios::in | std::ios::out);
    file.put('#');  // as many bytes as before
  }
  fs::last_write_time(folder_ / "in/b.obj", time);
  EXPECT_EQ(with_cache(), (Names{"", "the scan changed"}));
  fs::resize_file(folder_ / "archive/scans/a.obj.vtkhdf", 1000);
  EXPECT_EQ(with_cache(), (Names{kDamaged, "the scan changed"}));
}

TEST_F(SurfacePlanTest, ADamagedDatasetIsRunAgain) {
  run_all();
  fs::resize_file(folder_ / "archive/scans/a.obj.vtkhdf", 1000);
  std::ofstream(folder_ / "archive/scans/b.obj.vtkhdf") << "not HDF5";
  EXPECT_EQ(reasons(), (Names{kDamaged, kDamaged}));
  run_all();
  EXPECT_EQ(reasons(), kBothUpToDate);
}

TEST_F(SurfacePlanTest, AMissingSidecarIsNoticed) {
  run_all();
  fs::remove(folder_ / "archive/scans/b.obj.xdmf");
  EXPECT_EQ(reasons(), (Names{"", "its .xdmf is missing"}));
  EXPECT_TRUE(surface_data(plan_scans(config_)[1].job).sidecar_only);
}

TEST_F(SurfacePlanTest, DamagedArraysAreFoundWhenAskedFor) {
  tests::write_obj(folder_ / "in/b.obj", shapes::cube(1, 9));  // too large for compact arrays
  run_all();
  {
    std::fstream file(folder_ / "archive/scans/b.obj.vtkhdf",
                      std::ios::in | std::ios::out | std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::size_t stream = bytes.find("\x78\x01");  // the first chunk that is deflated
    ASSERT_NE(stream, std::string::npos);
    file.seekp(static_cast<std::streamoff>(stream + 12));
    file.put(static_cast<char>(bytes[stream + 12] ^ 1));
  }
  auto plan = plan_scans(config_);
  EXPECT_EQ(reasons(), kBothUpToDate);
  verify_surfaces(plan, 2);
  EXPECT_TRUE(plan[0].up_to_date);
  EXPECT_FALSE(plan[1].up_to_date);
  EXPECT_FALSE(surface_data(plan[1].job).sidecar_only);
  EXPECT_EQ(in_short(plan[1].reasons), "its arrays are damaged");

  std::ofstream(folder_ / "archive/scans/a.obj.xdmf") << "<Xdmf>";
  plan = plan_scans(config_);
  verify_surfaces(plan, 2);
  EXPECT_TRUE(surface_data(plan[0].job).sidecar_only);
  EXPECT_EQ(in_short(plan[0].reasons), "its .xdmf is damaged");
}

TEST_F(SurfacePlanTest, ScansOfTheSameNameInTwoRunsGetTwoDatasets) {
  run_all();
  fs::create_directories(folder_ / "other");
  tests::write_obj(folder_ / "other/a.obj", shapes::cube(1, 3));
  config_.inputs = {folder_ / "other"};
  EXPECT_EQ(reasons(), Names{kMissing});
  const std::string name = plan_scans(config_)[0].job.name;
  EXPECT_TRUE(name.starts_with("a.obj--")) << name;
  run_all();
  EXPECT_EQ(reasons(), Names{""});
  config_.inputs = {folder_ / "other", folder_ / "in"};
  EXPECT_EQ(reasons(), (Names{"", "", ""}));
  // Scans that move take their datasets with them.
  fs::rename(folder_ / "in", folder_ / "moved");
  fs::rename(folder_ / "other", folder_ / "zother");
  config_.inputs = {folder_ / "zother", folder_ / "moved"};
  EXPECT_EQ(reasons(), (Names{"", "", ""}));
}

TEST_F(SurfacePlanTest, NamesThatAreNoUtf8AreDescribedAsUtf8) {
  fs::create_directories(folder_ / "in/bad\xff");
  tests::write_obj(folder_ / "in/bad\xff/c.obj", shapes::cube(1, 2));
  run_all();
  const auto plan = plan_scans(config_);
  ASSERT_EQ(plan.size(), 3u);
  EXPECT_TRUE(plan[2].up_to_date);
  EXPECT_EQ(io::Dataset(plan[2].job.output).header().input_name, "bad\uFFFD/c.obj");
  EXPECT_EQ(io::Dataset(plan[0].job.output).header().input_name, "a.obj");
}

TEST_F(SurfacePlanTest, AnUnreadableScanIsPlannedWithItsError) {
  fs::create_symlink("gone", folder_ / "in/c.obj");
  ASSERT_EQ(mkfifo((folder_ / "in/d.obj").c_str(), 0600), 0);
  const auto plan = plan_scans(config_);
  ASSERT_EQ(plan.size(), 4u);
  EXPECT_TRUE(plan[0].error.empty());
  EXPECT_NE(plan[2].error.find("c.obj"), std::string::npos) << plan[2].error;
  EXPECT_NE(plan[3].error.find("d.obj"), std::string::npos) << plan[3].error;
  EXPECT_FALSE(plan[2].up_to_date);
}

TEST_F(SurfacePlanTest, WritesNothing) {
  fs::remove_all(folder_ / "archive");
  reasons();
  EXPECT_FALSE(fs::exists(folder_ / "archive"));
}

}  // namespace
}  // namespace semigeo::jobs
