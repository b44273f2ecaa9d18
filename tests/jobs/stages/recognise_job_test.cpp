#include "jobs/stages/recognise_job.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "jobs/stages/recognised_file.hpp"
#include "jobs/stages/surface_job.hpp"
#include "jobs/stages/triplets_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A library of one model, a noisy torus, and that torus as a scene.
class RecogniseJobTest : public testing::Test {
 protected:
  RecogniseJobTest() {
    kernels::TriangleMesh torus = shapes::torus(1, 0.4, 60, 24, 0.3);
    shapes::add_noise(torus, 0.02, 1);
    job_.scene = tests::write_obj(folder_ / "scene.obj", torus);
    job_.input_xxh3 = io::xxh3_of_file(job_.scene);
    job_.input_name = "below/scene.obj";
    job_.name = "below__scene.obj";
    job_.output = folder_ / "scene.json";
    job_.key = "k";
    dataset_ = folder_ / "torus.vtkhdf";
    run_surface_job({.input = job_.scene,
                     .input_name = "t",
                     .name = "torus",
                     .output = dataset_,
                     .input_xxh3 = job_.input_xxh3,
                     .key = "s"},
                    {.levels = 1}, context_);
    make_library(json_of(RecognitionParameters{}));
  }
  void make_library(const nlohmann::json& parameters) {
    const fs::path run = folder_ / "torus.run";
    run_triplets_job({.dataset = dataset_,
                      .name = "torus",
                      .output = run,
                      .key_of = [](const std::string& key) { return key; }},
                     {}, context_);
    const fs::path part = folder_ / "all.part";
    run_partition_job({.runs = {run}, .shapes = {0, kernels::kShapes}, .output = part, .key = "p"},
                      context_);
    job_.library = folder_ / "library.h5";
    job_.library_digest = run_library_job({.runs = {run},
                                           .partitions = {part},
                                           .parameters = parameters,
                                           .output = job_.library,
                                           .key = "l"},
                                          context_)
                              .digest;
  }
  std::string refused() {
    try {
      run_recognise_job(job_, {}, context_);
    } catch (const io::Error& error) {
      EXPECT_FALSE(fs::exists(job_.output));
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }

  tests::TemporaryFolder folder_;
  engine::Workers workers_{2};
  engine::Observer observer_;
  engine::RunContext context_{workers_, observer_, {}};
  fs::path dataset_;
  RecogniseJob job_;
};

TEST_F(RecogniseJobTest, TheFileSaysWhatAndWhere) {
  const RecogniseJobResult result = run_recognise_job(job_, {.min_score = 0.5}, context_);
  const nlohmann::json document = read_recognised(job_.output);
  EXPECT_EQ(document["scene"]["name"], "below__scene.obj");
  EXPECT_EQ(document["scene"]["input_name"], "below/scene.obj");
  EXPECT_EQ(document["scene"]["format"], "OBJ");
  EXPECT_EQ(document["scene"]["repairs"]["welded_vertices"], 0);
  EXPECT_EQ(document["scene"]["features"], result.features);
  EXPECT_EQ(document["scene_triplets"], result.triplets);
  EXPECT_EQ(document["library"]["digest"], job_.library_digest);
  EXPECT_EQ(document["search"]["min_score"], 0.5);
  EXPECT_GT(result.triplets, 100);
  ASSERT_EQ(result.objects, 1);
  const nlohmann::json& object = document["objects"][0];
  EXPECT_EQ(object["model"], "torus");
  EXPECT_GT(object["match"], 0.9);
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_NEAR(object["pose"]["matrix"][i][j].get<double>(), i == j, 0.01);
  EXPECT_EQ(recognised_key(job_.output), "k");
}

TEST_F(RecogniseJobTest, ThreadsDoNotMatter) {
  const auto bytes = [&](int threads, RecognitionMethod method) {
    engine::Workers workers(threads);
    run_recognise_job(job_, {.method = method}, {workers, observer_, {}});
    return bytes_of(job_.output);
  };
  for (const auto method : {RecognitionMethod::kOverlap, RecognitionMethod::kThesis})
    EXPECT_EQ(bytes(1, method), bytes(3, method));
}

TEST_F(RecogniseJobTest, ADatasetIsAScene) {
  job_.scene = dataset_;
  job_.input_xxh3 = io::xxh3_of_file(dataset_);
  EXPECT_EQ(run_recognise_job(job_, {.min_score = 0.5}, context_).objects, 1);
  EXPECT_EQ(read_recognised(job_.output)["scene"]["format"], "dataset");
}

// An open scene does not say which of its sides is outside. Both are tried.
TEST_F(RecogniseJobTest, AnOpenSceneThatFacesTheOtherWayIsRecognised) {
  kernels::TriangleMesh part = shapes::torus(1, 0.4, 60, 24, 0.3);
  shapes::add_noise(part, 0.02, 1);
  std::erase_if(part.triangles, [&](const auto& t) { return part.points[t[0]].x() < -0.5; });
  for (const bool turned : {false, true}) {
    if (turned)
      for (auto& t : part.triangles) std::swap(t[1], t[2]);
    tests::write_obj(job_.scene, part);
    job_.input_xxh3 = io::xxh3_of_file(job_.scene);
    ASSERT_EQ(run_recognise_job(job_, {}, context_).objects, 1) << turned;
    const nlohmann::json document = read_recognised(job_.output);
    EXPECT_EQ(document["scene"]["turned"], turned);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        EXPECT_NEAR(document["objects"][0]["pose"]["matrix"][i][j].get<double>(), i == j, 0.02);
  }
}

// All triangles face upwards: the scene is taken to be seen from far above.
TEST_F(RecogniseJobTest, TheFileSaysFromWhereASceneWasSeen) {
  kernels::TriangleMesh part = shapes::torus(1, 0.4, 60, 24, 0.3);
  shapes::add_noise(part, 0.02, 1);
  std::erase_if(part.triangles, [&](const auto& t) {
    const Eigen::Vector3d normal =
        (part.points[t[1]] - part.points[t[0]]).cross(part.points[t[2]] - part.points[t[0]]);
    return normal.z() < 0.3 * normal.norm();
  });
  tests::write_obj(job_.scene, part);
  job_.input_xxh3 = io::xxh3_of_file(job_.scene);
  run_recognise_job(job_, {.min_score = 0}, context_);
  const nlohmann::json seen = read_recognised(job_.output);
  ASSERT_TRUE(seen["scene"].contains("eye"));
  EXPECT_GT(seen["scene"]["eye"][2].get<double>(), 100);
  ASSERT_FALSE(seen["ranking"].empty());
  EXPECT_GT(seen["ranking"][0]["view"]["there"].get<double>(), 0);
  run_recognise_job(job_, {.min_score = 0, .view = ViewChoice::kNone}, context_);
  const nlohmann::json all = read_recognised(job_.output);
  EXPECT_FALSE(all["scene"].contains("eye"));
  ASSERT_FALSE(all["ranking"].empty());
  EXPECT_FALSE(all["ranking"][0].contains("view"));
}

TEST_F(RecogniseJobTest, OtherScalesAreLeftOut) {
  EXPECT_EQ(run_recognise_job(job_, {.scale = "known"}, context_).objects, 1);
  EXPECT_EQ(run_recognise_job(job_, {.scale = "1.5..3"}, context_).objects, 0);
}

TEST_F(RecogniseJobTest, WhatHasChangedMeanwhileIsRefused) {
  const std::string xxh3 = job_.input_xxh3;
  job_.input_xxh3 = "another";
  EXPECT_NE(refused().find("scene.obj: the file changed while it was read"), std::string::npos);
  job_.scene = dataset_;
  EXPECT_NE(refused().find("torus.vtkhdf: the file changed while it was read"), std::string::npos);
  job_.scene = folder_ / "scene.obj";
  job_.input_xxh3 = xxh3;
  job_.library_digest = "another";
  EXPECT_NE(refused().find("library.h5: the library has changed meanwhile"), std::string::npos);
}

TEST_F(RecogniseJobTest, ParametersThatAreUnknownAreRefused) {
  using nlohmann::json;
  const json known = json_of(RecognitionParameters{});
  json more = known;
  more["more"] = 1;
  json less = known;
  less.erase("least_reach");
  for (const json& parameters : {json(), json("none"), json(7), json{{"levels", 3}}, less, more,
                                 json_of(RecognitionParameters{.levels = 0})}) {
    make_library(parameters);
    EXPECT_NE(refused().find("parameters that this version does not know: " + parameters.dump()),
              std::string::npos)
        << parameters;
  }
}

TEST_F(RecogniseJobTest, ADamagedFileIsNotBelieved) {
  run_recognise_job(job_, {}, context_);
  const std::string good = bytes_of(job_.output);
  EXPECT_EQ(recognised_key(job_.output), "k");
  for (std::size_t at = 0; at < good.size(); at += 37) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    std::ofstream(job_.output, std::ios::binary) << bytes;
    EXPECT_THROW(recognised_key(job_.output), io::Error) << at;
  }
  std::ofstream(job_.output, std::ios::binary) << good.substr(0, good.size() / 2);
  EXPECT_THROW(recognised_key(job_.output), io::Error);
  fs::remove(job_.output);
  EXPECT_THROW(recognised_key(job_.output), io::Error);
}

}  // namespace
}  // namespace semigeo::jobs
