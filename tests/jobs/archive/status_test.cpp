#include "jobs/archive/status.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/files/error.hpp"
#include "jobs/archive/utc_time.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class StatusTest : public testing::Test {
 protected:
  /// Three of four jobs begun, one done, one failed.
  void begin_run(const char* name) {
    Journal journal(folder_.path(), name);
    journal.write(RunStarted{.version = "1", .jobs = 4, .up_to_date = 2, .input_bytes = 4000});
    for (const char* job : {"surface a", "surface b", "surface c"})
      journal.write(JobStarted{.job = job, .key = "k"});
    journal.write(JobEnded{
        .job = "surface a", .state = "done", .vertices = 500, .levels = 9, .input_bytes = 1000});
    journal.write(
        JobEnded{.job = "surface b", .state = "failed", .error = "b: no", .input_bytes = 1000});
  }
  ArchiveStatus status() { return status_of(folder_.path()); }

  tests::TemporaryFolder folder_;
};

TEST_F(StatusTest, OfARunThatGoesOn) {
  const ArchiveLock lock(folder_.path());
  begin_run("one");
  const ArchiveStatus now = status();
  EXPECT_TRUE(now.is_running());
  EXPECT_EQ(now.owner->process, this_process());
  EXPECT_EQ(now.done, 1);
  EXPECT_EQ(now.failed, (std::map<std::string, std::string>{{"surface b", "b: no"}}));
  EXPECT_EQ(now.running.size(), 1);
  EXPECT_TRUE(now.running.contains("surface c"));
  EXPECT_EQ(now.left(), 2);
  EXPECT_EQ(now.vertex_levels, 4500);
  EXPECT_EQ(now.last_run->up_to_date, 2);
  // Half of the bytes are read: as long again.
  ASSERT_TRUE(now.seconds_left().has_value());
  EXPECT_DOUBLE_EQ(*now.seconds_left(), now.seconds);
}

TEST_F(StatusTest, CountsJobsOfEveryKind) {
  Journal journal(folder_.path(), "one");
  journal.write(RunStarted{.version = "1", .jobs = 6, .up_to_date = 2});
  journal.write(JobEnded{.job = "surface a", .state = "done"});
  journal.write(JobEnded{.job = "surface b", .state = "failed", .error = "b: no"});
  journal.write(JobEnded{.job = "triplets a", .state = "done"});
  journal.write(JobEnded{.job = "triplets b", .state = "skipped"});
  journal.write(JobEnded{.job = "library l.h5", .state = "up to date"});
  const ArchiveStatus then = status();
  EXPECT_EQ(then.done, 2);
  EXPECT_EQ(then.done_by_kind,
            (std::map<std::string, std::int64_t>{{"surface", 1}, {"triplets", 1}}));
  EXPECT_EQ(then.skipped, 1);
  EXPECT_EQ(then.up_to_date, 3);
  EXPECT_EQ(then.left(), 1);
}

TEST_F(StatusTest, OfARunThatWasKilled) {
  begin_run("one");
  const ArchiveStatus then = status();
  EXPECT_FALSE(then.is_running());
  EXPECT_FALSE(then.ended);
  EXPECT_FALSE(then.owner.has_value());
  EXPECT_EQ(then.running.size(), 1);  // cut off
  EXPECT_FALSE(then.seconds_left().has_value());
}

TEST_F(StatusTest, OfTheLastOfSeveralRuns) {
  begin_run("one");
  Journal journal(folder_.path(), "two");
  journal.write(RunStarted{.version = "1", .jobs = 1, .up_to_date = 5});
  journal.write(JobStarted{.job = "surface c", .key = "k"});
  journal.write(JobEnded{.job = "surface c", .state = "done", .vertices = 10, .levels = 1});
  journal.write(RunEnded{.done = 1, .up_to_date = 5});
  const ArchiveStatus then = status();
  EXPECT_TRUE(then.ended);
  EXPECT_EQ(then.done, 1);
  EXPECT_TRUE(then.failed.empty());
  EXPECT_TRUE(then.running.empty());
  EXPECT_EQ(then.left(), 0);
  EXPECT_EQ(then.vertex_levels, 10);
}

TEST_F(StatusTest, OfARunWhoseBeginningIsFarBack) {
  begin_run("one");
  const fs::path journal = folder_ / "journal.jsonl";
  std::ofstream(journal, std::ios::app) << std::string(100, ' ') << '\n';
  fs::resize_file(journal, std::uintmax_t{8} << 30);  // gigabytes that take no room
  std::ofstream(journal, std::ios::app) << '\n';
  Journal(folder_.path(), "one").write(JobEnded{.job = "surface c", .state = "done"});
  const ArchiveStatus now = status();
  ASSERT_TRUE(now.last_run.has_value());
  EXPECT_EQ(now.done, 1);
  EXPECT_FALSE(now.ended);
}

TEST_F(StatusTest, OfAnArchiveThatHasNeverRun) {
  fs::create_directory(folder_ / "scans");
  std::ofstream(folder_ / "scans/a.vtkhdf");
  std::ofstream(folder_ / "scans/.b.vtkhdf.host.1.partial");
  std::ofstream(folder_ / "scans/a.xdmf");
  std::ofstream(folder_ / "journal.jsonl") << "{\"torn";
  const ArchiveStatus none = status();
  EXPECT_FALSE(none.last_run.has_value());
  EXPECT_EQ(none.datasets, 1);
  EXPECT_EQ(none.damaged_lines, 1);
  EXPECT_EQ(none.left(), 0);
  EXPECT_THROW(status_of(folder_ / "nothing"), io::Error);
}

TEST(UtcTimeTest, SecondsSince) {
  EXPECT_NEAR(seconds_since(utc_time()), 0, 2);
  EXPECT_NEAR(seconds_since("1970-01-02T00:00:00Z") + 86400, seconds_since("1970-01-01T00:00:00Z"),
              2);
  EXPECT_EQ(seconds_since("yesterday"), 0);
}

}  // namespace
}  // namespace semigeo::jobs
