#include "jobs/report/run_history.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "jobs/report/run_figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

class RunHistoryTest : public testing::Test {
 protected:
  void run(const std::string& name, const std::vector<JobEnded>& ends) {
    Journal journal(folder_.path(), name);
    journal.write(RunStarted{.version = "1", .threads = 2, .passed_over = "2 .jpg"});
    for (const JobEnded& end : ends) {
      journal.write(JobStarted{.job = end.job});
      journal.write(end);
    }
    journal.write(RunEnded{});
  }
  RunHistory read() { return read_history(folder_.path()); }

  tests::TemporaryFolder folder_;
};

TEST_F(RunHistoryTest, JobsThatMakePagesAreLeftOutUnlessTheyFail) {
  run("one", {{.job = "surface a.ply", .state = "done", .seconds = 2, .vertices = 5, .levels = 3}});
  const RunHistory before = read();
  run("two",
      {{.job = "page a.ply", .state = "done"}, {.job = "report index.html", .state = "done"}});
  EXPECT_EQ(read().digest, before.digest);
  EXPECT_EQ(read().run.ended, before.run.ended);
  EXPECT_TRUE(read().running.empty());
  run("three", {{.job = "page a.ply", .state = "failed", .error = "no"}});
  EXPECT_NE(read().digest, before.digest);
  EXPECT_EQ(read().run.failed.at("page a.ply"), "no");
  // What a night was like is told by the run that made datasets.
  EXPECT_EQ(read().night.spans.size(), 1u);
  EXPECT_TRUE(read().run.spans.empty());
}

TEST_F(RunHistoryTest, TheLastEndOfADatasetCountsAndTheLastThatMadeIt) {
  run("one", {{.job = "surface a.ply", .state = "done", .seconds = 2}});
  run("two", {{.job = "surface a.ply", .state = "failed", .error = "no"}});
  EXPECT_EQ(read().last.at("a.ply").state, "failed");
  EXPECT_EQ(read().made.at("a.ply").seconds, 2);
}

TEST(RunFiguresTest, CoreTimeAndThroughputAddUp) {
  // Two cores for 100 s. One job had a core for 80 s and computed for 60 s; the second had one for
  // 20 s from second 80 on.
  LastRun run;
  run.start = {.threads = 2, .passed_over = "2 .jpg"};
  run.seconds = 100;
  run.cpu_seconds = 80;
  run.spans = {{.begin = 0, .end = 80, .threads = 1, .vertex_levels = 800},
               {.begin = 80, .end = 100, .threads = 1, .vertex_levels = 200}};
  const nlohmann::json figures = figures_of(run);
  EXPECT_DOUBLE_EQ(figures["vertex_levels_per_second"], 10);
  const nlohmann::json& time = figures["core_time"];
  EXPECT_NEAR(time["computing"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(time["waiting"].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(time["held"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(time["tail"].get<double>(), 0.1, 1e-9);
  const auto rate = figures["curve"]["rate"].get<std::vector<double>>();
  const double work = std::accumulate(rate.begin(), rate.end(), 0.0);
  EXPECT_NEAR(work * figures["curve"]["seconds"].get<double>(), 1000, 50);
  for (const double cores : figures["curve"]["cores"]) EXPECT_NEAR(cores, 1, 1e-9);
  EXPECT_EQ(figures["passed_over"], "2 .jpg");
}

TEST_F(RunHistoryTest, CoresThatPagesHadDuringARunCount) {
  run("one", {{.job = "page a.ply", .state = "done", .seconds = 3, .cpu_seconds = 2, .threads = 1},
              {.job = "surface b.ply", .state = "done", .seconds = 5, .threads = 1},
              {.job = "scene s.ply", .state = "done", .seconds = 1, .threads = 1},
              {.job = "report index.html", .state = "done", .seconds = 1, .threads = 1}});
  run("two", {{.job = "page c.ply", .state = "done", .seconds = 3, .threads = 1}});
  const LastRun last = read().run;
  EXPECT_EQ(last.spans.size(), 3u);
  EXPECT_EQ(last.cpu_seconds, 2);
  EXPECT_EQ(last.seconds, 5);
  EXPECT_EQ(last.ended.at("done"), 1);
}

TEST(RunFiguresTest, ACurveOfAnyLengthHasFewSteps) {
  for (const double seconds : {1e3, 1e10, 1e300}) {
    LastRun run;
    run.seconds = seconds;
    run.spans = {{.begin = 0, .end = seconds, .threads = 1, .vertex_levels = 800}};
    EXPECT_EQ(figures_of(run)["curve"]["rate"].size(), 96u) << seconds;
  }
}

TEST(RunFiguresTest, AShortRunHasNoCurve) {
  LastRun run;
  run.seconds = 3;
  run.spans = {{.begin = 0, .end = 3, .threads = 1, .vertex_levels = 800}};
  EXPECT_FALSE(figures_of(run).contains("curve"));
  EXPECT_FALSE(figures_of(run).contains("core_time"));
}

TEST_F(RunHistoryTest, ScansOfEarlierRunsAreKeptOnlyIfTheyAreShown) {
  run("one",
      {{.job = "surface a.ply", .state = "done"}, {.job = "surface b.ply", .state = "done"}});
  const auto shown = [](const std::string& name) { return name == "a.ply"; };
  // The last run is kept whole.
  EXPECT_EQ(read_history(folder_.path(), shown).last.size(), 2u);
  // It stays so when other things are made.
  run("recognition", {{.job = "recognise d.ply", .state = "done"}});
  EXPECT_EQ(read_history(folder_.path(), shown).last.size(), 2u);
  run("two", {{.job = "surface c.ply", .state = "failed", .error = "no"}});
  const RunHistory history = read_history(folder_.path(), shown);
  EXPECT_TRUE(history.last.contains("a.ply"));
  EXPECT_TRUE(history.last.contains("c.ply"));
  EXPECT_EQ(history.last.size(), 2u);
  EXPECT_EQ(history.made.size(), 1u);
}

}  // namespace
}  // namespace semigeo::jobs
