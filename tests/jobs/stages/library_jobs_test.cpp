#include "jobs/stages/library_job.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>

#include "io/files/error.hpp"
#include "io/library/hash_library.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/partition_job.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using tests::SampleLibrary;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// How a library is built from runs; nothing of it may be seen in the library.
struct Way {
  std::vector<int> cuts = {};  ///< shapes at which a partition ends and another begins
  std::int64_t memory = 0;
  int threads = 2;
};

class LibraryJobsTest : public testing::Test {
 protected:
  void write_runs(const SampleLibrary& sample) {
    runs_.clear();
    for (std::size_t i = 0; i < sample.models.size(); ++i) {
      runs_.push_back(folder_ / (sample.models[i].name + ".run"));
      io::write_triplet_run(runs_.back(), "key of " + sample.models[i].name, sample.models[i],
                            sample.triplets[i]);
    }
  }
  fs::path partition(io::ShapeRange shapes, const Way& way) {
    const PartitionJob job{
        .runs = runs_,
        .shapes = shapes,
        .output = folder_ / (std::to_string(shapes.first) + "-" + std::to_string(shapes.end)),
        .key = "partition key",
        .memory_bytes = way.memory};
    engine::Workers workers(way.threads);
    engine::Observer observer;
    const PartitionJobResult result = run_partition_job(job, {workers, observer, {}});
    EXPECT_EQ(result.postings, io::PostingPartition(job.output).postings());
    return job.output;
  }
  LibraryJobResult library(const std::vector<fs::path>& partitions, const Way& way) {
    const LibraryJob job{.runs = runs_,
                         .partitions = partitions,
                         .parameters = {{"levels", 3}},
                         .output = folder_ / "built.h5",
                         .key = "key",
                         .memory_bytes = way.memory};
    engine::Workers workers(way.threads);
    engine::Observer observer;
    return run_library_job(job, {workers, observer, {}});
  }
  std::vector<fs::path> partitions(const Way& way) {
    std::vector<fs::path> paths;
    int first = 0;
    for (const int cut : way.cuts)
      paths.push_back(partition({std::exchange(first, cut), cut}, way));
    paths.push_back(partition({first, kernels::kShapes}, way));
    return paths;
  }
  std::string build(const Way& way) {
    library(partitions(way), way);
    return bytes_of(folder_ / "built.h5");
  }
  std::string message_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const io::Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }

  tests::TemporaryFolder folder_;
  std::vector<fs::path> runs_;
};

// The reference sorts all postings at once, in memory.
TEST_F(LibraryJobsTest, AnyWayGivesTheSameBytes) {
  const SampleLibrary sample(90);  // more than a block of postings
  write_runs(sample);
  write_library(folder_ / "reference.h5", sample);
  const std::string expected = bytes_of(folder_ / "reference.h5");
  ASSERT_GT(sample.postings.size(), 65536U);
  EXPECT_EQ(build({}), expected);
  EXPECT_EQ(build({.threads = 1}), expected) << "one thread";
  EXPECT_EQ(build({.threads = 5}), expected) << "many threads";
  EXPECT_EQ(build({.cuts = {1, 17, 300, 301, 302, 671}}), expected) << "partitions";
  EXPECT_EQ(build({.cuts = {100, 100}}), expected) << "an empty partition";
  EXPECT_EQ(build({.cuts = {333}, .memory = 1 << 20}), expected) << "a few shapes at a time";
}

// Down to single cells that do not fit.
TEST_F(LibraryJobsTest, AnyMemoryGivesTheSameBytes) {
  SampleLibrary sample(12, {.features = 20, .samples = 5, .triplets = 50});
  // A shape that all of them have, and a cell of it.
  for (auto& triplets : sample.triplets)
    for (kernels::Triplet& triplet : triplets)
      triplet.cell =
          200 * kernels::kCodeTriples + (triplet.cell % 3 == 0 ? 77 : triplet.cell % 512);
  for (auto& triplets : sample.triplets) {
    std::ranges::sort(triplets, {}, [](const auto& t) { return std::tie(t.cell, t.corners); });
    const auto twice = std::ranges::unique(
        triplets, {}, [](const auto& t) { return std::tie(t.cell, t.corners); });
    triplets.erase(twice.begin(), twice.end());
  }
  write_runs(sample);
  const std::string expected = build({});
  for (const std::int64_t memory : {1, 500, 5000, 10000, 20000, 100000})
    EXPECT_EQ(build({.cuts = {199}, .memory = memory}), expected) << memory;
}

TEST_F(LibraryJobsTest, SaysWhatItMade) {
  const SampleLibrary sample(3);
  write_runs(sample);
  const LibraryJobResult result = library(partitions({.cuts = {100}}), {});
  EXPECT_EQ(result.models, 3);
  EXPECT_EQ(result.postings, sample.postings.size());
  const io::HashLibrary made(folder_ / "built.h5");
  EXPECT_EQ(result.digest, made.digest());
  EXPECT_EQ(io::posting_partition_key(folder_ / "100-672"), "partition key");
  EXPECT_EQ(io::library_key(folder_ / "built.h5"), "key");
  EXPECT_EQ(made.parameters(), (nlohmann::json{{"levels", 3}}));
}

TEST_F(LibraryJobsTest, NoModelsNoPostings) {
  write_runs(SampleLibrary(0));
  EXPECT_EQ(library(partitions({.cuts = {5}}), {}).postings, 0);
  EXPECT_TRUE(io::HashLibrary(folder_ / "built.h5").models().empty());
}

TEST_F(LibraryJobsTest, RefusesModelsOutOfOrder) {
  write_runs(SampleLibrary(3));
  const std::vector<fs::path> good = partitions({});
  std::swap(runs_[0], runs_[1]);
  const char* sentence = "model-000000 does not come after model-000001";
  EXPECT_NE(message_of([&] { partitions({}); }).find(sentence), std::string::npos);
  EXPECT_NE(message_of([&] { library(good, {}); }).find(sentence), std::string::npos);
  runs_ = {runs_[1], runs_[1]};
  EXPECT_NE(message_of([&] { partitions({}); }).find("does not come after"), std::string::npos);
}

TEST_F(LibraryJobsTest, RefusesPartitionsThatDoNotFit) {
  write_runs(SampleLibrary(3));
  const std::vector<fs::path> good = partitions({.cuts = {100, 200}});
  const auto refused = [&](const std::vector<fs::path>& some, const char* sentence) {
    const std::string message = message_of([&] { library(some, {}); });
    EXPECT_NE(message.find(sentence), std::string::npos) << message;
    EXPECT_FALSE(fs::exists(folder_ / "built.h5"));
  };
  refused({}, "the shapes from 0 on are missing");
  refused({good[0], good[1]}, "the shapes from 200 on are missing");
  refused({good[0], good[2]}, "begins with shape 200 instead of 100");
  refused({good[0], good[0], good[1], good[2]}, "begins with shape 0 instead of 100");
  runs_.pop_back();
  refused(good, "was not made of these models");
  write_runs(SampleLibrary(3, {.triplets = 999}));
  refused(good, "was not made of these models");
}

TEST_F(LibraryJobsTest, DamageIsAnErrorThatNamesTheFile) {
  write_runs(SampleLibrary(3));
  const std::vector<fs::path> good = partitions({.cuts = {100}});
  const auto damaged = [&](const fs::path& path, std::size_t at) {
    const std::string before = bytes_of(path);
    std::string bytes = before;
    bytes.at(at) = static_cast<char>(bytes[at] ^ 4);
    std::ofstream(path, std::ios::binary) << bytes;
    const std::string message = message_of([&] {
      if (path.extension() == ".run") partitions({.cuts = {100}});
      library(good, {});
    });
    EXPECT_TRUE(message.starts_with(path.string())) << message;
    std::ofstream(path, std::ios::binary) << before;
  };
  damaged(good[1], 5000);                             // a posting
  damaged(good[0], fs::file_size(good[0]) - 100);     // a count
  damaged(runs_[1], 3000);                            // a triplet
  damaged(runs_[1], 12 + 24 * 1000 + 38 * 150);       // a feature
  damaged(runs_[2], fs::file_size(runs_[2]) - 3000);  // an offset
  fs::remove(runs_[1]);
  EXPECT_TRUE(message_of([&] { library(good, {}); }).starts_with(runs_[1].string()));
}

TEST(PartitionShapes, HaveEveryShapeOnce) {
  std::size_t before = 1;
  for (const std::int64_t models : {0, 1, 999, 1000, 1001, 10000, 100000, 100000000}) {
    const std::vector<io::ShapeRange> ranges = partition_shapes(models);
    EXPECT_EQ(ranges.front().first, 0);
    EXPECT_EQ(ranges.back().end, kernels::kShapes);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      EXPECT_LT(ranges[i].first, ranges[i].end);
      if (i > 0) EXPECT_EQ(ranges[i].first, ranges[i - 1].end);
    }
    EXPECT_GE(ranges.size(), before);
    before = ranges.size();
  }
  EXPECT_EQ(partition_shapes(1000).size(), 1U);
  EXPECT_EQ(partition_shapes(10000).size(), 10U);
}

}  // namespace
}  // namespace semigeo::jobs
