#include "jobs/run/run_journal.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <vector>

#include "jobs/run/local_runner.hpp"
#include "tests/jobs/scans_to_run.hpp"
#include "tests/jobs/written_text.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

TEST(RunJournalTest, TellsWhatARunDid) {
  const tests::TemporaryFolder folder;
  tests::ScansToRun config;
  config.inputs = {folder / "in"};
  config.archive = folder / "archive";
  config.surface.levels = 1;
  fs::create_directories(folder / "in");
  fs::create_directories(config.archive);
  tests::write_obj(folder / "in/a.obj", shapes::icosphere(2));
  std::ofstream(folder / "in/b.obj") << "v 0 0 0\n";
  const auto run = [&] {
    ExecutorOptions options;
    options.program = SEMIGEO_PROGRAM;
    options.logs = config.archive / "logs";
    options.threads = 1;  // one job after the other
    Progress progress(0, 0);
    RunJournal journal(config.archive, {.version = "1", .threads = 2, .jobs = 2});
    run_jobs(plan_scans(config), options, progress, &journal);
    journal.run_ended({.done = 1, .failed = 1});
    EXPECT_EQ(journal.problem(), "");
  };
  run();
  const auto plan = plan_scans(config);
  std::vector<JournalEntry> entries;
  read_journal(config.archive, [&](const JournalEntry& entry) { entries.push_back(entry); });
  ASSERT_EQ(entries.size(), 6u);
  for (const JournalEntry& entry : entries) EXPECT_EQ(entry.run, entries[0].run);
  EXPECT_EQ(std::get<RunStarted>(entries[0].event).pid, getpid());
  EXPECT_EQ(entries[1].event,
            JournalEvent(JobStarted{.job = "surface a.obj", .key = plan[0].job.key}));
  const auto& done = std::get<JobEnded>(entries[2].event);
  EXPECT_EQ(done.job, "surface a.obj");
  EXPECT_EQ(done.key, plan[0].job.key);
  EXPECT_EQ(done.state, "done");
  EXPECT_EQ(done.format, "OBJ");
  EXPECT_EQ(done.vertices, 162);
  EXPECT_EQ(done.levels, 2);
  EXPECT_EQ(done.threads, 1);
  EXPECT_EQ(done.input_bytes, static_cast<std::int64_t>(fs::file_size(folder / "in/a.obj")));
  EXPECT_GT(done.seconds, 0);
  EXPECT_GT(done.cpu_seconds, 0);
  EXPECT_GT(done.peak_bytes, 1e6);
  const auto& failed = std::get<JobEnded>(entries[4].event);
  EXPECT_EQ(failed.state, "failed");
  EXPECT_NE(failed.error.find("b.obj"), std::string::npos) << failed.error;
  EXPECT_EQ(failed.vertices, 0);
  EXPECT_EQ(std::get<RunEnded>(entries[5].event).failed, 1);

  run();  // another run has another name, and begins no job that is up to date
  entries.clear();
  read_journal(config.archive, [&](const JournalEntry& entry) { entries.push_back(entry); });
  EXPECT_EQ(entries.size(), 6u + 4u);
}

TEST(RunJournalTest, ARunGoesOnWithoutAJournal) {
  const tests::TemporaryFolder folder;
  fs::create_directory(folder / "journal.jsonl");
  RunJournal journal(folder.path(), {});
  const PlannedJob planned = tests::text_job("a", folder.path(), {});
  journal.job_started(planned);
  journal.job_ended(planned, {});
  journal.run_ended({});
  EXPECT_NE(journal.problem().find("journal.jsonl"), std::string::npos) << journal.problem();
}

}  // namespace
}  // namespace semigeo::jobs
