#include "jobs/plan/job_inputs.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "io/files/error.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/plan/job_key.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

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
  Job job(JobKind kind) {
    return {.kind = kind,
            .name = "x",
            .input = folder_.path(),
            .output = folder_ / "library.h5",
            .key = "of all models",
            .models = {"a", "b", "c"}};
  }

  tests::TemporaryFolder folder_;
};

TEST_F(JobInputsTest, ALibraryIsMadeOfTheModelsThatHaveRuns) {
  write_run("a", "key of a");
  write_run("c", "key of c");
  const std::vector<std::string> keys = {"key of a", "key of c"};
  JobInputs inputs({});
  Job library = job(JobKind::kLibrary);
  inputs.settle(library);
  EXPECT_EQ(library.models, (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(library.key, library_key(keys, {}));
  Job partition = job(JobKind::kPartition);
  partition.shapes = {.first = 3, .end = 5};
  inputs.settle(partition);
  EXPECT_EQ(partition.models, library.models);
  EXPECT_EQ(partition.key, partition_key(keys, partition.shapes));
}

TEST_F(JobInputsTest, ALibraryNeedsItsPartitions) {
  write_run("a", "key of a");
  Job library = job(JobKind::kLibrary);
  library.partitions = 1;
  EXPECT_THROW(JobInputs({}).settle(library), io::Error);
  fs::create_directories(folder_ / "partitions");
  std::ofstream(partition_path(folder_.path(), 0)) << "is looked at by its job";
  EXPECT_FALSE(JobInputs({}).settle(library));
}

TEST_F(JobInputsTest, ADamagedRunIsNoModel) {
  write_run("a", "key of a");
  std::ofstream(run_path(folder_.path(), "b")) << "no run";
  Job library = job(JobKind::kLibrary);
  JobInputs({}).settle(library);
  EXPECT_EQ(library.models, (std::vector<std::string>{"a"}));
}

TEST_F(JobInputsTest, WithoutModelsThereIsNothingToBeginWith) {
  Job library = job(JobKind::kLibrary);
  EXPECT_THROW(JobInputs({}).settle(library), io::Error);
  Job triplets = job(JobKind::kTriplets);
  triplets.input = folder_ / "none.vtkhdf";
  EXPECT_THROW(JobInputs({}).settle(triplets), io::Error);
}

TEST_F(JobInputsTest, OnlyRunsOfAnotherKeyAreStale) {
  write_run("a", "key of a");
  Job triplets{.kind = JobKind::kTriplets,
               .name = "a",
               .input = {},
               .output = run_path(folder_.path(), "a"),
               .key = "key of a"};
  remove_stale_run(triplets);
  EXPECT_TRUE(fs::exists(triplets.output));
  triplets.key = "of another dataset";
  remove_stale_run(triplets);
  EXPECT_FALSE(fs::exists(triplets.output));
}

}  // namespace
}  // namespace semigeo::jobs
