#include "jobs/stages/triplets_job.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

class TripletsJobTest : public testing::Test {
 protected:
  /// A noisy torus has features everywhere.
  TripletsJobTest() {
    kernels::TriangleMesh torus = shapes::torus(1, 0.4, 60, 24, 0.3);
    shapes::add_noise(torus, 0.02, 1);
    const fs::path scan = tests::write_obj(folder_ / "scan.obj", torus);
    const SurfaceParameters parameters = {.levels = 2, .length_unit = "mm"};
    SurfaceJob job;
    job.input = scan;
    job.name = "torus";
    job.output = folder_ / "torus.vtkhdf";
    job.input_xxh3 = io::xxh3_of_file(scan);
    job.key = "k";
    run_surface_job(job, parameters, {workers_, observer_, {}});
    job_ = {.dataset = job.output,
            .name = "torus",
            .output = folder_ / "torus.run",
            .key_of = [](const std::string& dataset_key) { return "of " + dataset_key; }};
  }

  tests::TemporaryFolder folder_;
  engine::Workers workers_{2};
  engine::Observer observer_;
  TripletsJob job_;
};

TEST_F(TripletsJobTest, RunHasTheModelAndItsTriplets) {
  const RecognitionParameters parameters = {.levels = 2, .samples = 500};
  const TripletsJobResult result = run_triplets_job(job_, parameters, {workers_, observer_, {}});
  const io::Dataset dataset(job_.dataset);
  const kernels::RecognitionModel expected =
      recognition_model(dataset, parameters, {workers_, observer_, {}});
  const io::TripletRun run(job_.output);
  EXPECT_EQ(run.job_key(), "of k");
  EXPECT_EQ(run.name(), "torus");
  const kernels::RecognitionModel model = run.read_model();
  EXPECT_EQ(model.digest, dataset.digest());
  EXPECT_EQ(model.length_unit, "mm");
  EXPECT_EQ(model.samples.points, expected.samples.points);
  EXPECT_EQ(result.features, model.features.features.size());
  EXPECT_EQ(result.samples, model.samples.points.size());
  const std::vector<kernels::Triplet> triplets = run.read_triplets();
  EXPECT_EQ(triplets, kernels::local_triplets(expected.features, {}));
  EXPECT_EQ(result.triplets, triplets.size());
  EXPECT_GT(result.triplets, 100);
}

TEST_F(TripletsJobTest, ThreadsDoNotMatter) {
  const auto bytes = [&](int threads) {
    engine::Workers workers(threads);
    run_triplets_job(job_, {}, {workers, observer_, {}});
    std::ifstream in(job_.output, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string one = bytes(1);
  EXPECT_EQ(bytes(3), one);
}

TEST_F(TripletsJobTest, RefusesWhatIsNoDataset) {
  job_.dataset = folder_ / "scan.obj";
  EXPECT_THROW(run_triplets_job(job_, {}, {workers_, observer_, {}}), io::Error);
  EXPECT_FALSE(fs::exists(job_.output));
}

/// A float holds a corner so far out, but not the square of its distance.
TEST_F(TripletsJobTest, AScanWithACornerFarOutIsRefusedInASentence) {
  kernels::TriangleMesh torus = shapes::torus(1, 0.4, 60, 24, 0.3);
  shapes::add_noise(torus, 0.02, 1);
  torus.points[0] = {1e25, 0, 0};
  SurfaceJob job;
  job.input = tests::write_obj(folder_ / "far.obj", torus);
  job.name = "far";
  job.output = folder_ / "far.vtkhdf";
  job.input_xxh3 = io::xxh3_of_file(job.input);
  job.key = "k";
  run_surface_job(job, {.levels = 2}, {workers_, observer_, {}});
  job_.dataset = job.output;
  try {
    run_triplets_job(job_, {}, {workers_, observer_, {}});
    ADD_FAILURE() << "a model was made";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), job.output);
    EXPECT_NE(error.problem().find("not finite"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace semigeo::jobs
