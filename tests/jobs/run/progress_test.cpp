#include "jobs/run/progress.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace semigeo::jobs {
namespace {

TEST(ProgressTest, ShortNumbers) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(17), "17");
  EXPECT_EQ(short_number(9999), "9999");
  EXPECT_EQ(short_number(340'000), "340 k");
  EXPECT_EQ(short_number(1'234'567), "1.23 M");
  EXPECT_EQ(short_number(2.5e9), "2.50 G");
}

TEST(ProgressTest, ShortDurations) {
  EXPECT_EQ(short_duration(0), "0.0 s");
  EXPECT_EQ(short_duration(3.14), "3.1 s");
  EXPECT_EQ(short_duration(45.2), "45 s");
  EXPECT_EQ(short_duration(59.9), "1 min 00 s");
  EXPECT_EQ(short_duration(200), "3 min 20 s");
  EXPECT_EQ(short_duration(3599.9), "1 h 00 min");
  EXPECT_EQ(short_duration(7500), "2 h 05 min");
}

TEST(ProgressTest, ALineFitsIntoAnyWidth) {
  const std::string counts = "1 done, 0 failed, 12 left";
  const std::string name = "vases__krug__a_rather_long_name.ply";
  EXPECT_EQ(progress_line(counts, name, 100), counts + ", " + name);
  EXPECT_EQ(progress_line(counts, name, counts.size() + 2 + name.size()), counts + ", " + name);
  EXPECT_EQ(progress_line(counts, name, counts.size() + 2 + 13), counts + ", vases...e.ply");
  EXPECT_EQ(progress_line(counts, name, counts.size() + 5), counts);
  EXPECT_EQ(progress_line(counts, "a.ply", counts.size() + 7), counts + ", a.ply");
  EXPECT_EQ(progress_line(counts, name, 6), "1 done");
  for (std::size_t width = 0; width < 80; ++width)
    EXPECT_LE(progress_line(counts, name, width).size(), width);
}

TEST(ProgressTest, AddsUpWorkOfAllThreads) {
  Progress progress(1, 100);
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      for (int i = 0; i < 1000; ++i) progress.worked(3);
    });
  threads.clear();
  EXPECT_EQ(progress.vertex_levels(), 4 * 1000 * 3);
}

// Where nobody watches: one line a minute, so a short run says only what it is told to say.
TEST(ProgressTest, AwayFromATerminalItIsQuiet) {
  testing::internal::CaptureStderr();
  {
    Progress progress(2, 10);
    progress.job_started("a.ply");
    progress.worked(1000);
    progress.job_ended(true, 5);
    progress.say("failed: b.ply: is empty");
    progress.job_ended(false, 5);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "failed: b.ply: is empty\n");
}

}  // namespace
}  // namespace semigeo::jobs
