// A kind of jobs that only this test knows goes through everything that the program's own kinds go
// through. This program is the worker of its jobs: see main.

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "jobs/archive/journal.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/plan/plan_graph.hpp"
#include "jobs/run/local_runner.hpp"
#include "jobs/run/run.hpp"
#include "jobs/run/worker.hpp"
#include "tests/jobs/written_text.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_faults.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using enum JobState;

class NewKindTest : public testing::Test {
 protected:
  NewKindTest() {
    fs::create_directories(folder_ / "pages");
    options_.program = fs::read_symlink("/proc/self/exe");
    options_.logs = folder_ / "home/logs";
    options_.threads = 2;
  }
  std::vector<PlannedJob> plan() {
    return {tests::text_job("one", folder_ / "pages", {.text = "first"}),
            tests::text_job("two", folder_ / "pages", {.text = second_}, {0})};
  }
  RunResult run() {
    LocalRunner runner(options_);
    testing::internal::CaptureStderr();
    RunResult result =
        perform_run({.home = folder_ / "home", .program_version = "1"},
                    {.plan = [this](DigestCache&) { return plan(); },
                     .runner = [&](const auto& planned) -> Runner& {
                       prepare_folders(planned, options_);
                       return runner;
                     },
                     .settings = [this] { return execution_settings(options_); },
                     .warn = [](const std::string& what) { ADD_FAILURE() << what; }});
    said_ = testing::internal::GetCapturedStderr();
    return result;
  }
  static std::vector<JobState> states(const RunResult& result) {
    std::vector<JobState> states;
    for (const JobOutcome& outcome : result.outcomes) states.push_back(outcome.state);
    return states;
  }
  nlohmann::json printed(const std::function<void()>& print) {
    testing::internal::CaptureStdout();
    print();
    return nlohmann::json::parse(testing::internal::GetCapturedStdout());
  }

  tests::TemporaryFolder folder_;
  ExecutorOptions options_;
  std::string second_ = "second";
  std::string said_;
};

TEST_F(NewKindTest, IsListedByTheGraphAndTheDryRun) {
  std::string text;
  write_graph_json(plan(), [&](std::string_view piece) { text += piece; });
  const auto graph = nlohmann::json::parse(text);
  ASSERT_EQ(graph["nodes"].size(), 4u);
  EXPECT_EQ(graph["nodes"][0]["id"], "text one");
  EXPECT_EQ(graph["nodes"][1]["kind"], "page");
  EXPECT_EQ(graph["nodes"][2]["dependencies"][0], graph["nodes"][1]["id"]);
  const auto dry = printed([&] { cli::print_plan(plan(), true, false); });
  EXPECT_EQ(dry["jobs"][0]["kind"], "text");
  EXPECT_EQ(dry["jobs"][0]["state"], "would run");
  EXPECT_EQ(dry["jobs"][0]["reason"], "no page yet");
}

TEST_F(NewKindTest, RunsInAChildAndIsJournalled) {
  const RunResult result = run();
  EXPECT_EQ(states(result), (std::vector{kDone, kDone})) << said_;
  std::ifstream page(folder_ / "pages/two");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(page), {}), "key of two\nsecond");
  EXPECT_EQ(result.summary.vertex_levels, 11);  // the letters
  const auto document = printed([&] { cli::print_json(result); });
  EXPECT_EQ(document["jobs"][1]["letters"], 6);
  std::vector<std::string> ended;
  read_journal(folder_ / "home", [&](const JournalEntry& entry) {
    if (const auto* job = std::get_if<JobEnded>(&entry.event)) ended.push_back(job->job);
  });
  EXPECT_EQ(ended, (std::vector<std::string>{"text one", "text two"}));
  EXPECT_EQ(states(run()), (std::vector{kUpToDate, kUpToDate}));
}

TEST_F(NewKindTest, PrintsEveryLineOfItsReports) {
  const RunResult result = run();
  testing::internal::CaptureStdout();
  cli::print_run(result);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_TRUE(
      text.starts_with("written: one: 5 letters\nwritten: two: 6 letters\n"
                       "closed: one: the book\nclosed: two: the book\n2 done"))
      << text;
}

TEST_F(NewKindTest, ThatFailsSaysWhy) {
  second_ = "fail";
  const RunResult result = run();
  EXPECT_EQ(states(result), (std::vector{kDone, kFailed}));
  EXPECT_NE(result.outcomes[1].error.find("give another text"), std::string::npos);
}

TEST_F(NewKindTest, ThatCrashesIsTriedAgain) {
  const tests::TestFaults faults("text one=crash-once");
  EXPECT_EQ(states(run()), (std::vector{kDone, kDone}));
  EXPECT_NE(said_.find("again: "), std::string::npos) << said_;
}

TEST_F(NewKindTest, ThatKeepsCrashingFailsAlone) {
  const tests::TestFaults faults("text one=crash");
  const RunResult result = run();
  EXPECT_EQ(states(result), (std::vector{kFailed, kDone}));
  EXPECT_NE(result.outcomes[0].error.find(": its text job crashed"), std::string::npos)
      << result.outcomes[0].error;
}

}  // namespace
}  // namespace semigeo::jobs

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "job")
    return semigeo::jobs::serve_jobs(STDIN_FILENO, 3,
                                     semigeo::jobs::JobKinds({&semigeo::tests::text_kind()}));
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
