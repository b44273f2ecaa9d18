#include "jobs/kinds/report_plan.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/kinds/report.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/report/report_files.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class ReportPlanTest : public testing::Test {
 protected:
  ReportPlanTest() {
    fs::create_directories(folder_ / "scans");
    fs::create_directories(folder_ / "report/scans");
  }
  void make_dataset(const std::string& name, int levels) {
    const fs::path scan = tests::write_obj(folder_ / "scan.obj", shapes::icosphere(1));
    SurfaceJob job;
    job.input = scan;
    job.input_name = name;
    job.output = folder_ / "scans" / (name + ".vtkhdf");
    job.input_xxh3 = io::xxh3_of_file(scan);
    job.key = "key of " + name + " with " + std::to_string(levels);
    run_surface_job(job, {.levels = levels}, context_.engine);
  }
  std::vector<PlannedJob> plan(bool index_only = false) {
    DigestCache cache(folder_.path());
    std::vector<PlannedJob> plan;
    plan_report(plan, models_of(folder_.path(), {}, cache),
                {.archive = folder_.path(),
                 .folder = report_folder(folder_.path()),
                 .index_only = index_only});
    return plan;
  }
  /// Does what is not up to date, as a run does it.
  void run(std::vector<PlannedJob> plan) {
    OutputKeys keys;
    for (PlannedJob& planned : plan)
      if (!planned.up_to_date && !planned.job.kind->resolve_inputs(planned.job, keys))
        planned.job.kind->run(planned.job, context_);
  }
  static std::vector<std::string> to_do(const std::vector<PlannedJob>& plan) {
    std::vector<std::string> names;
    for (const PlannedJob& planned : plan)
      if (!planned.up_to_date) names.push_back(job_id(planned.job));
    return names;
  }

  tests::TemporaryFolder folder_;
  engine::Workers workers_{1};
  engine::Observer observer_;
  JobContext context_{.engine = {workers_, observer_, {}}};
};

using Names = std::vector<std::string>;

TEST_F(ReportPlanTest, OnlyPagesOfWhatHasChangedAreMadeAgain) {
  make_dataset("a", 1);
  make_dataset("b", 1);
  EXPECT_EQ(to_do(plan()), (Names{"page a", "page b", "report index.html"}));
  run(plan());
  EXPECT_EQ(to_do(plan()), Names{});
  make_dataset("b", 2);
  EXPECT_EQ(to_do(plan()), (Names{"page b", "report index.html"}));
  run(plan());
  EXPECT_EQ(to_do(plan()), Names{});
  fs::remove(folder_ / "report/scans/a.html");
  EXPECT_EQ(to_do(plan()), (Names{"page a", "report index.html"}));
}

TEST_F(ReportPlanTest, TheFirstPageWaitsForAllJobs) {
  make_dataset("a", 1);
  make_dataset("b", 1);
  EXPECT_EQ(plan().back().after, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(to_do(plan(true)), Names{"report index.html"});
}

TEST_F(ReportPlanTest, PagesOfDatasetsThatAreGoneAreRemoved) {
  make_dataset("a", 1);
  make_dataset("b", 1);
  run(plan());
  std::ofstream(folder_ / "report/scans/mine.html") << "not a page of semigeo";
  fs::remove(folder_ / "scans/b.vtkhdf");
  EXPECT_EQ(to_do(plan()), Names{"report index.html"});
  run(plan());
  EXPECT_TRUE(fs::exists(folder_ / "report/scans/a.html"));
  EXPECT_FALSE(fs::exists(folder_ / "report/scans/b.html"));
  EXPECT_TRUE(fs::exists(folder_ / "report/scans/mine.html"));
}

TEST_F(ReportPlanTest, APageWithoutADatasetCannotBegin) {
  make_dataset("a", 1);
  std::vector<PlannedJob> planned = plan();
  fs::remove(folder_ / "scans/a.vtkhdf");
  OutputKeys keys;
  EXPECT_THROW(planned.front().job.kind->resolve_inputs(planned.front().job, keys), io::Error);
}

TEST_F(ReportPlanTest, ARecognisedFileWithoutAKeyStopsNoOtherPage) {
  make_dataset("a", 1);
  fs::create_directories(folder_ / "recognised");
  nlohmann::json document = {{"format", "semigeo-recognition"},
                             {"format_version", 1},
                             {"job_key", 7},
                             {"objects", nlohmann::json::array()}};
  document["digest"] = io::xxh3_of_text(document.dump());
  std::ofstream(folder_ / "recognised/s.json") << document.dump(2) << '\n';
  EXPECT_EQ(to_do(plan()), (Names{"page a", "scene s", "report index.html"}));
}

TEST_F(ReportPlanTest, JobsSurviveTheWayToAnotherProcess) {
  const Job scene = {.kind = &scene_kind(),
                     .name = "a",
                     .input = {},
                     .output = {},
                     .key = "",
                     .data = SceneJobData{.scene = "/x/\xff.ply", .archive = "/y"}};
  const std::any again = scene.kind->data_from_json(scene.kind->data_to_json(scene));
  EXPECT_EQ(std::any_cast<SceneJobData>(again).scene, "/x/\xff.ply");
  const Job report = report_job("/x", "/x/report", true);
  const std::any index = report.kind->data_from_json(report.kind->data_to_json(report));
  EXPECT_TRUE(std::any_cast<ReportJobData>(index).index_only);
}

TEST_F(ReportPlanTest, AnArchiveIsNeeded) {
  fs::remove(folder_ / "scans");
  EXPECT_THROW(plan(), io::Error);
}

TEST_F(ReportPlanTest, ThePageOfASceneIsMadeAgainWhenTheSceneOrAModelThatItNamesHasChanged) {
  make_dataset("a", 1);
  make_dataset("ranked", 1);
  fs::create_directories(folder_ / "recognised");
  nlohmann::json document = {{"format", "semigeo-recognition"},
                             {"format_version", 1},
                             {"job_key", "k"},
                             {"objects", nlohmann::json::array()},
                             {"ranking", {{{"model", "ranked"}}}}};
  document["digest"] = io::xxh3_of_text(document.dump());
  std::ofstream(folder_ / "recognised/s.json") << document.dump(2) << '\n';
  const fs::path scene = tests::write_obj(folder_ / "scene.obj", shapes::icosphere(1));
  const auto key = [&] { return scene_job("s", scene, folder_.path(), folder_ / "report").key; };
  const std::string first = key();
  EXPECT_EQ(key(), first);
  make_dataset("a", 2);
  EXPECT_EQ(key(), first) << "the page does not name it";
  make_dataset("ranked", 2);
  const std::string second = key();
  EXPECT_NE(second, first);
  tests::write_obj(folder_ / "scene.obj", shapes::icosphere(2));
  const std::string third = key();
  EXPECT_NE(third, second);
  fs::remove(scene);
  EXPECT_NE(key(), third);
}

TEST_F(ReportPlanTest, WhatTheFirstPageShowsIsReadFromIt) {
  make_dataset("a", 1);
  make_dataset("b", 1);
  run(plan(true));
  fs::remove_all(folder_ / "scans");
  EXPECT_EQ(shown_on_first_page(folder_ / "report/index.html").scans, 2);
  EXPECT_EQ(shown_on_first_page(folder_ / "report/none.html").scans, 0);
}

TEST_F(ReportPlanTest, APageIsExpectedToNeedMoreMemoryIfItsDatasetIsLarger) {
  make_dataset("a", 1);
  const std::vector<PlannedJob> planned = plan();
  const Estimates learned;
  const EstimateContext context = {.plan = planned, .learned = learned, .memory_bytes = 0};
  const auto bytes = [&] { return page_kind().estimate(planned.front(), context).peak_bytes; };
  EXPECT_LT(bytes(), 50e6);
  fs::resize_file(folder_ / "scans/a.vtkhdf", 1'000'000'000);  // sparse
  EXPECT_GT(bytes(), 2e9);
}

}  // namespace
}  // namespace semigeo::jobs
