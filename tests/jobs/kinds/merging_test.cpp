#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "io/files/error.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/triplets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> models_of(const Job& library) {
  return library.kind->data_to_json(library).at("models").get<std::vector<std::string>>();
}

class JobInputsTest : public testing::Test {
 protected:
  JobInputsTest() { fs::create_directories(folder_ / "triplets"); }
  /// A run without triplets.
  void write_run(const std::string& name, const std::string& key) {
    kernels::RecognitionModel model;
    model.name = name;
    model.digest = std::string(32, 'd');
    io::write_triplet_run(run_path(folder_.path(), name), key, model, {});
  }
  Job library(int partitions = 0) {
    return library_job({.models = {"a", "b", "c"}, .partitions = partitions},
                       folder_ / "library.h5", folder_.path(), {});
  }
  Job partition(const io::ShapeRange& shapes) {
    return partition_job(
        0, {.models = {"a", "b", "c"}, .shapes = shapes, .library = folder_ / "library.h5"},
        folder_.path(), {});
  }
  static bool resolve(Job& job) {
    OutputKeys keys;
    return job.kind->resolve_inputs(job, keys);
  }

  tests::TemporaryFolder folder_;
};

TEST_F(JobInputsTest, ALibraryIsMadeOfTheModelsThatHaveRuns) {
  write_run("a", "key of a");
  write_run("c", "key of c");
  const std::vector<std::string> keys = {"key of a", "key of c"};
  Job whole = library();
  resolve(whole);
  EXPECT_EQ(models_of(whole), (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(whole.key, library_key(keys, {}));
  const io::ShapeRange shapes = {.first = 3, .end = 5};
  Job part = partition(shapes);
  resolve(part);
  EXPECT_EQ(part.kind->data_to_json(part).at("models"), (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(part.key, partition_key(keys, shapes));
}

TEST_F(JobInputsTest, ALibraryNeedsItsPartitions) {
  write_run("a", "key of a");
  Job whole = library(1);
  EXPECT_THROW(resolve(whole), io::Error);
  fs::create_directories(folder_ / "partitions");
  std::ofstream(partition_path(folder_.path(), 0)) << "is looked at by its job";
  EXPECT_FALSE(resolve(whole));
}

TEST_F(JobInputsTest, ADamagedRunIsNoModel) {
  write_run("a", "key of a");
  std::ofstream(run_path(folder_.path(), "b")) << "no run";
  Job whole = library();
  resolve(whole);
  EXPECT_EQ(models_of(whole), (std::vector<std::string>{"a"}));
}

TEST_F(JobInputsTest, WithoutModelsThereIsNoLibrary) {
  Job whole = library();
  EXPECT_THROW(resolve(whole), io::Error);
}

TEST_F(JobInputsTest, WithoutItsDatasetThereIsNoRun) {
  Job triplets = triplets_job("x", folder_ / "none.vtkhdf", "", folder_.path(), {});
  try {
    resolve(triplets);
    FAIL() << "resolved the inputs of a dataset that was never made";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), triplets.output);
    EXPECT_EQ(error.problem(), "there is no dataset to make it of");
    EXPECT_EQ(error.remedy(), "see why the jobs before it failed, and run again");
  }
}

TEST_F(JobInputsTest, ADamagedDatasetIsNotAMissingOne) {
  std::ofstream(folder_ / "x.vtkhdf") << "no dataset";
  Job triplets = triplets_job("x", folder_ / "x.vtkhdf", "", folder_.path(), {});
  try {
    resolve(triplets);
    FAIL() << "resolved the inputs of a damaged dataset";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), folder_ / "x.vtkhdf");
  }
}

TEST_F(JobInputsTest, OnlyRunsOfAnotherKeyAreStale) {
  write_run("a", "key of a");
  Job triplets = triplets_job("a", {}, "", folder_.path(), {});
  triplets.key = "key of a";
  triplets.kind->remove_stale_output(triplets);
  EXPECT_TRUE(fs::exists(triplets.output));
  triplets.key = "of another dataset";
  triplets.kind->remove_stale_output(triplets);
  EXPECT_FALSE(fs::exists(triplets.output));
}

}  // namespace
}  // namespace semigeo::jobs
