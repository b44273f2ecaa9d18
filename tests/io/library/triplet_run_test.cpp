#include "io/library/triplet_run.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "io/files/chunk_codec.hpp"
#include "io/files/error.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/generated_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

using kernels::RecognitionModel;
using kernels::Triplet;

std::string read_all(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_all(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class TripletRunTest : public testing::Test {
 protected:
  void write() { write_triplet_run(path_, "key", model_, triplets_); }
  std::string message() {
    try {
      const TripletRun run(path_);
      run.read_triplets();
      run.read_model();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "run";
  tests::ModelSize size_{.features = 60, .samples = 80, .triplets = 400};
  RecognitionModel model_ = tests::generated_model(3, size_);
  std::vector<Triplet> triplets_ = tests::generated_triplets(3, model_, size_);
};

TEST_F(TripletRunTest, HoldsWhatWasWritten) {
  write();
  const TripletRun run(path_);
  EXPECT_EQ(run.job_key(), "key");
  EXPECT_EQ(triplet_run_key(path_), "key");
  EXPECT_EQ(run.name(), model_.name);
  EXPECT_EQ(run.features(), 60);
  EXPECT_EQ(run.samples(), 80);
  EXPECT_EQ(run.levels(), 3);
  EXPECT_EQ(run.read_triplets(), triplets_);
  const RecognitionModel model = run.read_model();
  const RecognitionModel expected = unpack_model(pack_model(model_));
  EXPECT_EQ(model.digest, model_.digest);
  EXPECT_EQ(model.length_unit, model_.length_unit);
  EXPECT_EQ(model.origin, model_.origin);
  EXPECT_EQ(model.centre, model_.centre);
  EXPECT_EQ(model.diagonal, model_.diagonal);
  EXPECT_EQ(model.features.level_scale, model_.features.level_scale);
  EXPECT_EQ(model.samples.points, model_.samples.points);
  EXPECT_EQ(model.samples.normals, expected.samples.normals);
  EXPECT_EQ(model.samples.spacing, model_.samples.spacing);
  ASSERT_EQ(model.features.features.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(model.features.features[i].position, model_.features.features[i].position);
    EXPECT_EQ(model.features.features[i].code, model_.features.features[i].code);
    EXPECT_EQ(model.features.features[i].level, model_.features.features[i].level);
  }
}

TEST_F(TripletRunTest, RangesOfShapesTogetherAreAll) {
  write();
  const TripletRun run(path_);
  std::vector<Triplet> together;
  for (int first = 0; first < kernels::kShapes; first += 77) {
    const ShapeRange shapes{first, std::min(first + 77, kernels::kShapes)};
    const std::vector<Triplet> some = run.read_triplets(shapes);
    EXPECT_EQ(some.size(), run.triplets(shapes));
    for (const Triplet& triplet : some) {
      EXPECT_GE(triplet.cell, shapes.first_cell());
      EXPECT_LT(triplet.cell, shapes.end_cell());
    }
    together.insert(together.end(), some.begin(), some.end());
  }
  EXPECT_EQ(together, triplets_);
  EXPECT_TRUE(run.read_triplets({5, 5}).empty());
}

TEST_F(TripletRunTest, MayBeEmpty) {
  model_ = {};
  model_.name = "nothing";
  triplets_.clear();
  write();
  const TripletRun run(path_);
  EXPECT_TRUE(run.read_triplets().empty());
  EXPECT_EQ(run.read_model().name, "nothing");
}

TEST_F(TripletRunTest, ContentHashTellsContentsApart) {
  write();
  const std::uint64_t hash = TripletRun(path_).content_hash();
  const std::string bytes = read_all(path_);
  write();
  EXPECT_EQ(read_all(path_), bytes);
  triplets_.back().invariants[3] ^= 1;
  write();
  const std::uint64_t other = TripletRun(path_).content_hash();
  EXPECT_NE(other, hash);
  model_.samples.points[9].x() += 1;
  write();
  EXPECT_NE(TripletRun(path_).content_hash(), other);
}

// Every byte has a checksum over it, or is one.
TEST_F(TripletRunTest, DamageAnywhereIsNoticed) {
  write();
  const std::string good = read_all(path_);
  for (std::size_t at = 0; at < good.size(); at += 23) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1 << at % 8);
    write_all(path_, bad);
    EXPECT_NE(message(), "") << "byte " << at;
    EXPECT_THROW(triplet_run_key(path_), Error) << "byte " << at;
  }
  for (std::size_t size = 0; size < good.size(); size += 211) {
    write_all(path_, good.substr(0, size));
    EXPECT_NE(message(), "") << size << " bytes";
  }
  write_all(path_, good + "x");
  EXPECT_NE(message(), "");
}

TEST_F(TripletRunTest, SaysWhatIsWrong) {
  EXPECT_NE(message().find("there is no such file"), std::string::npos);
  write_all(path_, "text that is long enough for a header");
  EXPECT_NE(message().find("is not a run of triplets"), std::string::npos);
  write();
  std::string bytes = read_all(path_);
  bytes[8] = 2;
  write_all(path_, bytes);
  EXPECT_NE(message().find("is version 2 of a run of triplets, this program reads 1"),
            std::string::npos);
  bytes[8] = 1;
  bytes[20] ^= 1;
  write_all(path_, bytes);
  EXPECT_NE(message().find("its bytes do not match their checksum"), std::string::npos);
}

TEST_F(TripletRunTest, RefusesTripletsOutOfOrder) {
  const auto refused = [&] {
    EXPECT_THROW(write(), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(path_));
  };
  const std::vector<Triplet> good = triplets_;
  std::swap(triplets_[10], triplets_[11]);
  refused();
  triplets_ = good;
  triplets_[11] = triplets_[10];
  refused();
  triplets_ = good;
  triplets_[10].corners[1] = 60;
  refused();
  triplets_ = good;
  triplets_.back().cell = kernels::kTripletCells;
  refused();
}

TEST_F(TripletRunTest, RefusesUnsoundModels) {
  model_.features.features[7].code = kernels::kFeatureCodes;
  EXPECT_THROW(write(), std::invalid_argument);
  model_.features.features[7].code = 0;
  model_.samples.normals.pop_back();
  EXPECT_THROW(write(), std::invalid_argument);
}

TEST_F(TripletRunTest, FullDiskLeavesNothing) {
  const tests::FileSizeLimit limit(2000);
  EXPECT_THROW(write(), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace semigeo::io
