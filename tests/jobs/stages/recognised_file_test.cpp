#include "jobs/stages/recognised_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "io/files/error.hpp"
#include "io/files/small_file.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr io::TextBounds kBounds = {.bytes = 1 << 20};

class RecognisedFileTest : public testing::Test {
 protected:
  /// Writes a scene with two models in its ranking, one of them an object.
  void write() const {
    const fs::path path = folder_ / "library.h5";
    tests::write_library(path, tests::SampleLibrary(2));
    const io::HashLibrary library(path);
    const Candidate first = {.model = 1,
                             .votes = 1e-5,
                             .score = 0.5,
                             .view = kernels::View(),
                             .pose = {.scale = 0.1, .translation = {1.0 / 3, -2e-12, 4e15}}};
    const Recognition recognition = {
        .ranking = {first, Candidate()}, .objects = {first}, .scene_triplets = 100, .matches = 7};
    write_recognised(file_, "a key",
                     {.name = "scene", .input_name = "scene.ply", .eye = Eigen::Vector3d(1, 2, 3)},
                     library, {}, recognition);
  }

  /// Puts these bytes where the file is, and expects them to be refused.
  void expect_refused(std::string_view bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
    EXPECT_THROW(read_recognised(file_), io::Error) << bytes;
  }

  tests::TemporaryFolder folder_;
  fs::path file_ = folder_ / "scene.json";
};

TEST_F(RecognisedFileTest, WhatWasWrittenIsRead) {
  write();
  const nlohmann::json document = read_recognised(file_);
  EXPECT_EQ(recognised_key(file_), "a key");
  EXPECT_EQ(document["scene"]["name"], "scene");
  EXPECT_EQ(document["scene"]["eye"], (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(document["objects"].size(), 1u);
  EXPECT_EQ(document["ranking"].size(), 2u);
  EXPECT_EQ(document["objects"][0], document["ranking"][0]);
  EXPECT_EQ(document["matches"], 7);
}

TEST_F(RecognisedFileTest, AFlippedBitOfEveryByteIsFound) {
  write();
  const std::string bytes = io::read_text(file_, kBounds);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 9) {
    std::string changed = bytes;
    changed[bit / 8] ^= static_cast<char>(1 << bit % 8);
    expect_refused(changed);
  }
}

TEST_F(RecognisedFileTest, EveryFileThatIsCutOffIsRefused) {
  write();
  const std::string bytes = io::read_text(file_, kBounds);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    expect_refused(std::string_view(bytes).substr(0, length));
  }
}

}  // namespace
}  // namespace semigeo::jobs
