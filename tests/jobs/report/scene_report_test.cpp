#include "jobs/report/scene_report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "io/dataset/dataset.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/stages/search_parameters.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A sphere is the model. The scene is twice as large, and its middle lies at (10, 0, 0).
class SceneReportTest : public testing::Test {
 protected:
  SceneReportTest() {
    fs::create_directories(folder_ / "scans");
    const fs::path scan = tests::write_obj(folder_ / "model.obj", shapes::icosphere(3));
    SurfaceJob job;
    job.input = scan;
    job.input_name = "<b>model.obj";
    job.output = folder_ / "scans/model.vtkhdf";
    job.input_xxh3 = io::xxh3_of_file(scan);
    engine::Workers workers(1);
    engine::Observer observer;
    run_surface_job(job, {.levels = 1}, {workers, observer, {}});
    kernels::TriangleMesh mesh = shapes::icosphere(3);
    for (Eigen::Vector3d& p : mesh.points) p = 2 * p + Eigen::Vector3d(10, 0, 0);
    scene_ = tests::write_obj(folder_ / "scene.obj", mesh);
    digest_ = io::xxh3_of_file(scene_);
  }

  json candidate(double x) const {
    return {{"model", "model"},
            {"model_digest", io::Dataset(folder_ / "scans/model.vtkhdf").digest()},
            {"score", 0.5},
            {"pose",
             {{"scale", 2}, {"matrix", {{2, 0, 0, x}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}}}}}};
  }

  /// Writes what was recognised, and returns what its page shows.
  json report(const json& objects) const {
    json document = {{"format", "semigeo-recognition"},
                     {"format_version", 1},
                     {"job_key", "1234"},
                     {"scene", {{"input_name", "scene.obj"}, {"xxh3", digest_}}},
                     {"search", json_of(SearchParameters{})},
                     {"objects", objects},
                     {"ranking", objects}};
    document["digest"] = io::xxh3_of_text(document.dump());
    const fs::path file = folder_ / "recognised.json";
    std::ofstream(file) << document.dump(2) << '\n';
    return scene_report({.recognised = file, .scene = scene_, .archive = folder_.path()});
  }

  tests::TemporaryFolder folder_;
  fs::path scene_;
  std::string digest_;
};

TEST_F(SceneReportTest, AModelInItsPoseHasNoDistance) {
  const json shown = report(json::array({candidate(10)}));
  EXPECT_EQ(shown["title"], "scene.obj");
  EXPECT_EQ(shown["titles"]["model"], "<b>model.obj");
  EXPECT_EQ(shown["surface"]["shown_vertices"], 642);
  ASSERT_EQ(shown["models"].size(), 1);
  EXPECT_EQ(shown["models"][0]["shown_vertices"], 642);
  const json& object = shown["objects"][0];
  EXPECT_EQ(object["shape"], 0);
  EXPECT_EQ(object["residual"]["share"], 1);
  EXPECT_LT(object["residual"]["median"], 1e-5);
  EXPECT_GT(shown["residual"]["limit"], 0.3);
}

TEST_F(SceneReportTest, AMovedModelHasTheDistanceOfItsSurface) {
  const json shown = report(json::array({candidate(10), candidate(10.1), candidate(100)}));
  EXPECT_EQ(shown["models"].size(), 1);
  // Moved by d along x, the distance at a point is about d |x|, whose median on a sphere is d / 2.
  EXPECT_NEAR(shown["objects"][1]["residual"]["median"].get<double>(), 0.05, 0.01);
  EXPECT_EQ(shown["objects"][2]["residual"]["share"], 0);
  EXPECT_FALSE(shown["objects"][2]["residual"].contains("median"));
}

TEST_F(SceneReportTest, WhatIsGoneOrHasChangedIsNamed) {
  json other = candidate(10);
  other["model_digest"] = std::string(32, '0');
  json shown = report(json::array({other}));
  EXPECT_NE(shown["models"][0]["missing"].get<std::string>().find("has changed"),
            std::string::npos);
  EXPECT_FALSE(shown["objects"][0].contains("residual"));
  fs::remove(folder_ / "scans/model.vtkhdf");
  shown = report(json::array({other}));
  EXPECT_NE(shown["models"][0]["missing"].get<std::string>().find("is not in this archive"),
            std::string::npos);
  EXPECT_EQ(shown["titles"]["model"], "model");
  fs::remove(scene_);
  shown = report(json::array());
  EXPECT_TRUE(shown["surface"].contains("missing"));
  scene_.clear();
  EXPECT_TRUE(report(json::array())["surface"].contains("missing"));
}

TEST_F(SceneReportTest, APathIsNoNameOfAModel) {
  EXPECT_EQ(dataset_of_model("/archive", "../../etc/passwd"), "/archive/scans/passwd.vtkhdf");
}

TEST_F(SceneReportTest, AFileWithoutItsFieldsIsAnError) {
  EXPECT_THROW(report(json::array({{{"model", "model"}}})), io::Error);
}

}  // namespace
}  // namespace semigeo::jobs
