#include "jobs/archive/estimates.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// A job as the model would have it: so many bytes of file and memory a vertex, and microseconds a
/// vertex and level.
JobEnded job(std::int64_t vertices, double file_bytes, double memory_bytes, double microseconds,
             const std::string& format = "PLY binary") {
  JobEnded ended;
  ended.state = "done";
  ended.format = format;
  ended.vertices = vertices;
  ended.levels = 9;
  ended.threads = 2;
  ended.input_bytes = std::llround(file_bytes * static_cast<double>(vertices));
  ended.peak_bytes = 30e6 + memory_bytes * static_cast<double>(vertices);
  ended.seconds = 0.02 + 1e-6 * microseconds * static_cast<double>(vertices) * 9 / 2;
  return ended;
}

Estimates learned(const std::vector<JobEnded>& jobs) {
  EstimateLearner learner;
  for (const JobEnded& ended : jobs) learner.add(ended);
  return learner.learned();
}

TEST(EstimatesTest, WithoutExperienceTheyAreBuiltIn) {
  const Estimate estimate = Estimates().of({"PLY binary", 38'000'000}, 9, 2);
  EXPECT_DOUBLE_EQ(estimate.vertices, 1e6);
  EXPECT_DOUBLE_EQ(estimate.peak_bytes, 1.4 * (30e6 + 500e6));
  EXPECT_DOUBLE_EQ(estimate.seconds, 0.02 + 27);
  EXPECT_DOUBLE_EQ(Estimates().of({"STL binary", 100'000'000}, 9, 2).vertices, 1e6);
  const Estimate unknown = Estimates().of({"", 1'000'000}, 0, 0);
  EXPECT_GT(unknown.vertices, 26'000);  // rather too much
  EXPECT_GT(unknown.seconds, 0.02);
  EXPECT_DOUBLE_EQ(Estimates().of({}, 9, 1).peak_bytes, 1.4 * 30e6);
}

TEST(EstimatesTest, TheRatesOfJobsAreFound) {
  std::vector<JobEnded> jobs;
  for (int i = 0; i < 10; ++i) jobs.push_back(job(10'000 * (i + 1), 50, 700, 3));
  const Estimate estimate = learned(jobs).of({"PLY binary", 50'000'000}, 20, 4);
  EXPECT_NEAR(estimate.vertices, 1e6, 1);
  EXPECT_NEAR(estimate.peak_bytes, 1.4 * (30e6 + 700e6), 1e3);
  EXPECT_NEAR(estimate.seconds, 0.02 + 3 * 20. / 4, 1e-6);
}

TEST(EstimatesTest, AFewOddJobsDoNotMatter) {
  std::vector<JobEnded> jobs;
  for (int i = 0; i < 21; ++i)
    jobs.push_back(i % 3 == 0 ? job(20'000, 150, 5000, 60) : job(20'000, 50, 700, 3));
  const auto rates = learned(jobs).by_format().at("PLY binary");
  EXPECT_NEAR(*rates.file_bytes, 50, 1e-9);
  EXPECT_NEAR(*rates.memory_bytes, 700, 1e-9);
  EXPECT_NEAR(*rates.microseconds, 3, 1e-9);
}

TEST(EstimatesTest, LargeScansCountMore) {
  std::vector<JobEnded> jobs(9, job(10'000, 60, 2000, 20));
  jobs.push_back(job(1'000'000, 50, 700, 3));
  EXPECT_NEAR(*learned(jobs).by_format().at("PLY binary").memory_bytes, 700, 1e-9);
}

TEST(EstimatesTest, OnlyTheLastJobsCount) {
  std::vector<JobEnded> jobs(1000, job(10'000, 60, 2000, 20));
  jobs.insert(jobs.end(), 200, job(10'000, 50, 700, 3));
  EXPECT_NEAR(*learned(jobs).by_format().at("PLY binary").memory_bytes, 700, 1e-9);
}

TEST(EstimatesTest, FormatsHaveTheirOwnRatesAndShareThoseOfAll) {
  std::vector<JobEnded> jobs(5, job(10'000, 50, 700, 3));
  jobs.insert(jobs.end(), 3, job(10'000, 90, 900, 4, "OBJ"));
  jobs.insert(jobs.end(), 2, job(10'000, 100, 100, 1, "STL binary"));  // too few
  const Estimates estimates = learned(jobs);
  EXPECT_NEAR(estimates.of({"OBJ", 90'000'000}, 9, 1).peak_bytes, 1.4 * (30e6 + 900e6), 1e3);
  EXPECT_NEAR(estimates.of({"STL binary", 100'000'000}, 9, 1).peak_bytes, 1.4 * (30e6 + 700e6),
              1e3);
  EXPECT_EQ(estimates.by_format().size(), 2u);
}

TEST(EstimatesTest, NonsenseIsPassedOver) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const JobEnded good = job(10'000, 50, 700, 3);
  std::vector<JobEnded> jobs(3, good);
  const auto add = [&](auto change) {
    JobEnded odd = good;
    change(odd);
    jobs.insert(jobs.end(), 20, odd);
  };
  add([](JobEnded& odd) { odd = {}; });
  add([](JobEnded& odd) { odd.state = "failed"; });
  add([](JobEnded& odd) { odd.format.clear(); });
  for (const std::int64_t number :
       {std::int64_t{0}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()}) {
    add([&](JobEnded& odd) { odd.vertices = number; });
    add([&](JobEnded& odd) { odd.levels = number; });
    add([&](JobEnded& odd) { odd.threads = number; });
    add([&](JobEnded& odd) { odd.input_bytes = number; });
  }
  for (const double number : {nan, infinity, -infinity}) {
    add([&](JobEnded& odd) { odd.seconds = number; });
    add([&](JobEnded& odd) { odd.peak_bytes = number; });
  }
  add([](JobEnded& odd) {  // cannot be true, each by itself
    odd.seconds = 1e9;
    odd.peak_bytes = 1e18;
    odd.input_bytes = 1;
  });
  add([](JobEnded& odd) { odd = job(4, 150, 5e6, 90); });  // all of it is what every job costs
  const auto rates = learned(jobs).by_format().at("PLY binary");
  EXPECT_NEAR(*rates.file_bytes, 50, 1e-9);
  EXPECT_NEAR(*rates.memory_bytes, 700, 1e-9);
  EXPECT_NEAR(*rates.microseconds, 3, 1e-9);
}

TEST(EstimatesTest, MemoryThatIsNotKnownSpoilsNoTime) {
  std::vector<JobEnded> jobs(5, job(10'000, 50, 700, 3));
  for (JobEnded& ended : jobs) ended.peak_bytes = 0;
  const auto rates = learned(jobs).by_format().at("PLY binary");
  EXPECT_FALSE(rates.memory_bytes.has_value());
  EXPECT_NEAR(*rates.microseconds, 3, 1e-9);
}

class StoredEstimatesTest : public testing::Test {
 protected:
  void set_text(const std::string& text) { std::ofstream(file_) << text; }
  tests::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "estimates.json";
};

TEST_F(StoredEstimatesTest, ComeBackAndAreWrittenOnlyWhenTheyChange) {
  std::vector<JobEnded> jobs(5, job(10'000, 50.125, 700.3, 3.7));
  jobs.insert(jobs.end(), 3, job(10'000, 90, 900, 4, "OBJ"));
  const Estimates estimates = learned(jobs);
  estimates.write(folder_.path());
  const Estimates read = Estimates::read(folder_.path());
  EXPECT_EQ(read.by_format(), estimates.by_format());
  EXPECT_EQ(read.all(), estimates.all());
  const auto time = fs::last_write_time(file_);
  fs::permissions(folder_.path(), fs::perms::owner_read | fs::perms::owner_exec);
  read.write(folder_.path());
  fs::permissions(folder_.path(), fs::perms::owner_all);
  EXPECT_EQ(fs::last_write_time(file_), time);
}

TEST_F(StoredEstimatesTest, AbsentOrDamagedTheyAreBuiltIn) {
  for (const char* text : {"", "{", "[]", "7", "{}", R"({"all":1,"formats":{}})",
                           R"({"all":{},"formats":{"OBJ":{"file_bytes_per_vertex":"many"}}})",
                           R"({"all":{},"formats":{"OBJ":{"file_bytes_per_vertex":1e-9}}})",
                           R"({"all":{"memory_bytes_per_vertex":-5},"formats":{}})"}) {
    if (*text != '\0') set_text(text);
    const Estimates read = Estimates::read(folder_.path());
    EXPECT_EQ(read.of({"OBJ", 1000}, 9, 1).peak_bytes,
              Estimates().of({"OBJ", 1000}, 9, 1).peak_bytes)
        << text;
  }
}

TEST_F(StoredEstimatesTest, WhatIsNoFileIsPassedOverWithoutWaiting) {
  ASSERT_EQ(mkfifo((folder_ / "estimates.json").c_str(), 0666), 0);
  EXPECT_EQ(Estimates::read(folder_.path()).of({"PLY", 1000}, 9, 1).vertices,
            Estimates().of({"PLY", 1000}, 9, 1).vertices);
  learned({job(100'000, 30, 300, 10)}).write(folder_.path());
  EXPECT_TRUE(fs::is_regular_file(folder_ / "estimates.json"));
}

TEST_F(StoredEstimatesTest, AreLearnedFromTheJournal) {
  EXPECT_EQ(learn_estimates(folder_.path()).by_format().size(), 0u);
  {
    Journal journal(folder_.path(), "r");
    journal.write(RunStarted{});
    for (int i = 0; i < 3; ++i) {
      journal.write(JobStarted{});
      journal.write(job(10'000, 50, 700, 3));
    }
  }
  std::ofstream(folder_ / "journal.jsonl", std::ios::app) << "torn";
  const Estimates estimates = learn_estimates(folder_.path());
  EXPECT_NEAR(*estimates.by_format().at("PLY binary").memory_bytes, 700, 1e-9);
}

}  // namespace
}  // namespace semigeo::jobs
