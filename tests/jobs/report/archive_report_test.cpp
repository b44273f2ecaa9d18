#include "jobs/report/archive_report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/archive/names.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class ArchiveReportTest : public testing::Test {
 protected:
  ArchiveReportTest() { fs::create_directory(folder_ / "scans"); }

  void make_dataset(const std::string& name, const std::string& title) {
    const fs::path scan = tests::write_obj(folder_ / "scan.obj", shapes::icosphere(2));
    SurfaceJob job;
    job.input = scan;
    job.input_name = title;
    job.output = folder_ / "scans" / (name + ".vtkhdf");
    job.input_xxh3 = io::xxh3_of_file(scan);
    engine::Workers workers(1);
    engine::Observer observer;
    run_surface_job(job, {.levels = 1}, {workers, observer, {}});
  }
  nlohmann::json report() { return archive_report(folder_.path(), folder_ / "report"); }

  tests::TemporaryFolder folder_;
};

// HDF5 crashes over some changes of the list of what the virtual datasets show, and reads others
// for ever.
TEST_F(ArchiveReportTest, DamagedDatasetsHarmNoOther) {
  make_dataset("a.obj", "a.obj");
  std::stringstream whole;
  whole << std::ifstream(folder_ / "scans" / "a.obj.vtkhdf", std::ios::binary).rdbuf();
  const std::size_t heap = whole.str().find("GCOL");
  ASSERT_NE(heap, std::string::npos);
  for (std::size_t at = heap; at < heap + 400; at += 7) {
    std::string bad = whole.str();
    bad[at] = static_cast<char>(~bad[at]);
    std::ofstream(folder_ / "scans" / ("bad" + std::to_string(at) + ".vtkhdf"), std::ios::binary)
        << bad;
  }
  std::ofstream(folder_ / "scans" / "text.vtkhdf") << "text";
  const nlohmann::json document = report();
  ASSERT_EQ(document["scans"].size(), 60);
  EXPECT_EQ(document["scans"][0]["state"], "damaged");
  EXPECT_EQ(document["scans"].back()["state"], "done");
}

TEST_F(ArchiveReportTest, TellsWhatADatasetHoldsAndWhatItsJobTook) {
  make_dataset("a.obj", "a.obj");
  {
    Journal journal(folder_.path(), "one");
    journal.write(RunStarted{.version = "1", .jobs = 1});
    journal.write(
        JobEnded{.job = "surface a.obj", .state = "done", .seconds = 2, .peak_bytes = 3e6});
    journal.write(RunEnded{.done = 1});
    Journal later(folder_.path(), "two");
    later.write(RunStarted{.version = "1", .up_to_date = 1});
    later.write(JobEnded{.job = "surface a.obj", .state = "up to date"});
    later.write(RunEnded{});
  }
  const nlohmann::json document = report();
  EXPECT_EQ(document["run"]["state"], "ended");
  ASSERT_EQ(document["scans"].size(), 1);
  const nlohmann::json& scan = document["scans"][0];
  EXPECT_EQ(scan["state"], "done");
  EXPECT_EQ(scan["vertices"], 162);
  EXPECT_EQ(scan["triangles"], 320);
  EXPECT_EQ(scan["parts"], 1);
  EXPECT_EQ(scan["levels"], 2);
  EXPECT_EQ(scan["unit"], "unknown");
  EXPECT_EQ(scan["seconds"], 2);
  EXPECT_EQ(scan["peak_bytes"], 3e6);
  EXPECT_TRUE(scan["repairs"].empty());
  EXPECT_TRUE(document["failures"].empty());
}

TEST_F(ArchiveReportTest, FailuresComeFirstWithReasonAndRemedy) {
  make_dataset("a.obj", "a.obj");
  Journal journal(folder_.path(), "one");
  journal.write(RunStarted{.version = "1", .jobs = 3});
  journal.write(JobEnded{.job = "surface a.obj", .state = "done"});
  journal.write(JobEnded{
      .job = "surface b.obj", .state = "failed", .error = "b.obj: line 4: no number; mend it"});
  journal.write(JobEnded{.job = "library library.h5", .state = "failed", .error = "disk full"});
  const nlohmann::json document = report();
  ASSERT_EQ(document["scans"].size(), 2);
  EXPECT_EQ(document["scans"][0]["name"], "b.obj");
  EXPECT_EQ(document["scans"][0]["state"], "failed");
  EXPECT_FALSE(document["scans"][0].contains("vertices"));
  EXPECT_EQ(document["failures"],
            (nlohmann::json{
                {{"job", "b.obj"}, {"reason", "b.obj: line 4: no number"}, {"remedy", "mend it"}},
                {{"job", "library library.h5"}, {"reason", "disk full"}}}));
}

TEST_F(ArchiveReportTest, AFailureIsForgottenWhenTheScanSucceeds) {
  make_dataset("a.obj", "a.obj");
  Journal journal(folder_.path(), "one");
  journal.write(RunStarted{.version = "1", .jobs = 1});
  journal.write(JobEnded{.job = "surface a.obj", .state = "failed", .error = "no"});
  Journal later(folder_.path(), "two");
  later.write(RunStarted{.version = "1", .jobs = 1});
  later.write(JobEnded{.job = "surface a.obj", .state = "done"});
  EXPECT_EQ(report()["scans"][0]["state"], "done");
  EXPECT_TRUE(report()["failures"].empty());
  // It could not be read once, and is as it was.
  later.write(JobEnded{.job = "surface a.obj", .state = "failed", .error = "no"});
  EXPECT_EQ(report()["scans"][0]["state"], "failed");
  Journal last(folder_.path(), "three");
  last.write(RunStarted{.version = "1", .jobs = 1});
  last.write(JobEnded{.job = "surface a.obj", .state = "up to date"});
  EXPECT_EQ(report()["scans"][0]["state"], "done");
  EXPECT_TRUE(report()["failures"].empty());
}

TEST_F(ArchiveReportTest, AFailureStaysWhenALibraryIsMadeOrScenesAreRecognised) {
  make_dataset("a.obj", "a.obj");
  Journal journal(folder_.path(), "one");
  journal.write(RunStarted{.version = "1", .jobs = 2});
  journal.write(JobEnded{.job = "surface pipe.obj", .state = "failed", .error = "is no file; no"});
  Journal later(folder_.path(), "two");
  later.write(RunStarted{.version = "1", .jobs = 1});
  later.write(JobEnded{.job = "library library.h5", .state = "done"});
  // It never was a scan, so that nothing but the journal knows it.
  ASSERT_EQ(report()["scans"].size(), 2);
  EXPECT_EQ(report()["scans"][0]["state"], "failed");
  EXPECT_EQ(report()["failures"].size(), 1);
  Journal last(folder_.path(), "three");
  last.write(RunStarted{.version = "1", .jobs = 1});
  last.write(JobEnded{.job = "surface a.obj", .state = "done"});
  EXPECT_EQ(report()["scans"].size(), 1);
  EXPECT_TRUE(report()["failures"].empty());
}

TEST_F(ArchiveReportTest, ADatasetThatCannotBeReadIsAFailure) {
  std::ofstream(folder_ / "scans" / "a.obj.vtkhdf") << "nothing";
  const nlohmann::json document = report();
  EXPECT_EQ(document["scans"][0]["state"], "damaged");
  ASSERT_EQ(document["failures"].size(), 1);
  EXPECT_EQ(document["failures"][0]["job"], "a.obj");
}

TEST_F(ArchiveReportTest, WhatTheSystemRefusesToReadIsTold) {
  make_dataset("a.obj", "a.obj");
  EXPECT_TRUE(report()["unread"].empty());
  const std::string whole = archive_digest(folder_.path(), folder_ / "report");
  EXPECT_NE(whole, "");
  const fs::path circle = folder_ / "scans" / "b.obj.vtkhdf";
  fs::create_symlink(circle, circle);
  const nlohmann::json document = report();
  ASSERT_EQ(document["unread"].size(), 1);
  EXPECT_TRUE(document["unread"][0].get<std::string>().starts_with(circle.string() + ": "));
  EXPECT_EQ(archive_digest(folder_.path(), folder_ / "report"), "");
  fs::remove(circle);
  EXPECT_EQ(archive_digest(folder_.path(), folder_ / "report"), whole);
}

TEST_F(ArchiveReportTest, ScansHaveTheirOwnNames) {
  make_dataset("day_a.obj--1", "día/<img>.obj");
  Sources sources;
  sources.claim(dataset_name("day/β.obj"), "/scans/day/β.obj");
  sources.write(folder_.path());
  const nlohmann::json document = report();
  ASSERT_EQ(document["scans"].size(), 2);
  EXPECT_EQ(document["scans"][0]["title"], "day/β.obj");
  EXPECT_EQ(document["scans"][0]["state"], "missing");
  EXPECT_EQ(document["scans"][1]["title"], "día/<img>.obj");
}

TEST_F(ArchiveReportTest, AFolderWithoutAnythingIsNoArchive) {
  EXPECT_THROW(report(), io::Error);
  EXPECT_THROW(archive_report(folder_ / "absent", folder_ / "report"), io::Error);
}

}  // namespace
}  // namespace semigeo::jobs
