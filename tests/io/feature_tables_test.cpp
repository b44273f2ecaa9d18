#include "io/feature_tables.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <stdexcept>

#include "io/array_reader.hpp"
#include "io/error.hpp"
#include "io/file_digest.hpp"
#include "io/hdf5_library.hpp"
#include "tests/io/sample_dataset.hpp"
#include "tests/support/equal_features.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

using kernels::Feature;
using kernels::FeatureKind;
using kernels::LevelFeatures;

constexpr const char* kLevel = "/level";
constexpr std::int64_t kVertices = 40;

// A level with 10 to 16 features of each kind and 4 and 6 contours.
LevelFeatures sample() {
  return tests::sample_level({.vertices = kVertices, .triangles = 1}, 2).features;
}

class FeatureTables : public ::testing::Test {
 protected:
  void write(const LevelFeatures& features, Compression compression = Compression::deflate) {
    write(encode_features(features, compression));
  }
  void write(const EncodedFeatures& encoded, const std::function<void(Hdf5File&)>& change = {}) {
    DigestedFile file(Hdf5File::create(path_));
    file.create_group(kLevel);
    write_features(file, kLevel, encoded);
    if (change) change(file.file());
    digest_ = file.digest().hex();
    file.file().close();
  }
  /// What reading everything has to say; "" if nothing.
  std::string failure() const {
    try {
      const Hdf5File file = Hdf5File::open(path_);
      check_features(file, kLevel);
      for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
        read_features(file, kLevel, FeatureKind(kind), kVertices);
      for (int kind = 0; kind < kContourKinds; ++kind)
        read_contours(file, kLevel, FeatureKind(kind));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  void expect_refused(const std::string& place, const std::string& problem) const {
    const std::string found = failure();
    EXPECT_NE(found.find(std::string(kLevel) + "/" + place + ": "), std::string::npos) << found;
    EXPECT_NE(found.find(problem), std::string::npos) << found;
  }
  /// What is refused when one value of the contours H = 0 is wrong.
  void expect_refused(const std::function<void(kernels::SampledContours&)>& change,
                      const std::string& place, const std::string& problem) {
    LevelFeatures features = sample();
    change(features.contours[1]);
    write(features);
    expect_refused("contours/mean/" + place, problem);
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.h5";
  std::string digest_;
};

TEST_F(FeatureTables, EverythingComesBack) {
  LevelFeatures many = sample();
  for (int i = 0; i < 10'000; ++i) many.of_kind[0].push_back(many.of_kind[1][i % 7]);
  LevelFeatures none;
  for (kernels::SampledContours& contours : none.contours) contours.offsets = {0};
  for (const Compression compression : {Compression::none, Compression::deflate})
    for (const LevelFeatures& features : {sample(), many, none}) {
      write(features, compression);
      const Hdf5File file = Hdf5File::open(path_);
      EXPECT_EQ(content_digest(file), digest_);
      const FeatureCounts counts = check_features(file, kLevel);
      for (int kind = 0; kind < kernels::kFeatureKinds; ++kind) {
        const auto& wanted = features.of_kind[kind];
        EXPECT_TRUE(read_features(file, kLevel, FeatureKind(kind), kVertices) == wanted);
        EXPECT_EQ(counts.of_kind[kind], static_cast<std::int64_t>(wanted.size()));
      }
      for (int kind = 0; kind < kContourKinds; ++kind) {
        const auto& wanted = features.contours[kind];
        EXPECT_TRUE(read_contours(file, kLevel, FeatureKind(kind)) == wanted);
        EXPECT_EQ(counts.contours[kind], wanted.count());
        EXPECT_EQ(counts.contour_length[kind], wanted.length);
      }
    }
}

// Memory rows have 64 bytes, stored ones 60: HDF5's own filters must find the same ones.
TEST_F(FeatureTables, OtherReadersSeePackedRecords) {
  const LevelFeatures features = sample();
  for (const Compression compression : {Compression::none, Compression::deflate}) {
    write(features, compression);
    const Hdf5File file = Hdf5File::open(path_);
    const std::vector<std::byte> ours =
        read_records(file, "/level/features/mean", ElementType::feature);
    EXPECT_EQ(ours.size(), 60 * features.of_kind[1].size());
    EXPECT_EQ(ours, file.read_through_library("/level/features/mean"));
  }
}

TEST_F(FeatureTables, TheTypeOfARecordHasItsMembers) {
  std::string text;
  for (const RecordMember& member : kFeatureMembers) {
    text += (text.empty() ? "{" : ",") + std::string(member.name) + ":" +
            std::string(name_of(member.type));
    if (member.columns > 1) text += "[" + std::to_string(member.columns) + "]";
  }
  EXPECT_EQ(name_of(ElementType::feature), text + "}");
}

TEST_F(FeatureTables, TheDigestHasALineWithThatType) {
  const std::vector<Feature> features = sample().of_kind[0];
  const EncodedArray encoded = encode_array(array_of(features), Compression::deflate);
  DigestedFile file(Hdf5File::create(path_));
  file.write_array("/t", encoded);
  const std::vector<std::uint64_t> hashes = {encoded.chunks.at(0).raw_xxh3};
  std::array<char, 17> hash;
  std::snprintf(hash.data(), hash.size(), "%016llx",
                static_cast<unsigned long long>(xxh3_64(std::as_bytes(std::span(hashes)))));
  std::ofstream(folder_ / "lines") << "dataset /t " << name_of(ElementType::feature) << " "
                                   << features.size() << " " << hash.data() << "\ngroup /\n";
  EXPECT_EQ(file.digest().hex(), xxh3_of_file(folder_ / "lines"));
}

TEST_F(FeatureTables, VerticesMustExist) {
  for (const std::int64_t vertex : {std::int64_t{-1}, kVertices}) {
    LevelFeatures features = sample();
    features.of_kind[3][5].vertex = vertex;
    write(features);
    expect_refused("features/mean_torsion",
                   "feature 5 is at vertex " + std::to_string(vertex) + " of 40");
  }
}

TEST_F(FeatureTables, ContoursMustFollowOneAnother) {
  expect_refused([](auto& c) { c.offsets.front() = 1; }, "offsets", "does not begin at point 0");
  expect_refused([](auto& c) { c.offsets[2] = c.offsets[1]; }, "offsets",
                 "contour 1 has no points");
  expect_refused([](auto& c) { c.offsets[3] = 1000; }, "offsets",
                 "contour 3 has no points");
  expect_refused([](auto& c) { ++c.offsets.back(); }, "offsets", "ends at point 34 of 33");
  expect_refused([](auto& c) { --c.offsets.back(); }, "offsets", "ends at point 32 of 33");
}

TEST_F(FeatureTables, MarksAndMaximaMustMeanSomething) {
  expect_refused([](auto& c) { c.closed[2] = 2; }, "closed", "neither 0 nor 1");
  expect_refused([](auto& c) { c.maxima[0] = -1; }, "maxima", "refers to point -1 of 33");
  expect_refused([](auto& c) { c.maxima[4] = 33; }, "maxima", "refers to point 33 of 33");
}

// Removes an object, or puts the array /other in its place.
void replace(const std::filesystem::path& path, const std::string& name, bool by_other) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  ASSERT_GE(H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT), 0);
  if (by_other)
    ASSERT_GE(H5Lmove(file.get(), "/other", file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
}

TEST_F(FeatureTables, ShapesAndTypesMustFit) {
  const EncodedFeatures right = encode_features(sample(), Compression::none);
  const auto floats = [](std::size_t rows) {
    return encode_array(array_of(std::vector<float>(rows)), Compression::none);
  };
  const auto integers = [](std::size_t rows) {
    return encode_array(array_of(std::vector<std::int64_t>(rows)), Compression::none);
  };
  const std::pair<std::string, EncodedArray> wrong[] = {
      {"features/gaussian", floats(12)},          {"contours/mean/points", floats(33)},
      {"contours/mean/points", integers(33)},     {"contours/mean/torsion", floats(32)},
      {"contours/mean/torsion", integers(33)},    {"contours/mean/offsets", integers(6)},
      {"contours/mean/offsets", floats(7)},       {"contours/mean/closed", integers(6)},
      {"contours/gaussian/maxima", integers(13)}, {"contours/gaussian/maxima", floats(14)}};
  write(right);
  EXPECT_EQ(failure(), "");
  for (const auto& [name, array] : wrong) {
    write(right, [&](Hdf5File& file) { file.write_array("/other", array); });
    replace(path_, std::string(kLevel) + "/" + name, true);
    expect_refused(name, name.starts_with("features") ? "no table" : "type or shape");
  }
}

TEST_F(FeatureTables, ArraysMayNotBeMissing) {
  const EncodedFeatures right = encode_features(sample(), Compression::none);
  for (const std::string name :
       {"features/mean", "contours/gaussian/points", "contours/mean/maxima", "contours/mean"}) {
    write(right);
    replace(path_, kLevel + ("/" + name), false);
    EXPECT_NE(failure().find(kLevel + ("/" + name)), std::string::npos) << failure();
  }
}

TEST_F(FeatureTables, TheCountMustBeThatOfTheMarks) {
  write(encode_features(sample(), Compression::none));
  {
    const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle group(H5Oopen(file.get(), "/level/contours/mean", H5P_DEFAULT), H5Oclose);
    const Hdf5Handle count(H5Aopen(group.get(), "count", H5P_DEFAULT), H5Aclose);
    const std::int64_t five = 5;
    ASSERT_GE(H5Awrite(count.get(), H5T_STD_I64LE, &five), 0);
  }
  expect_refused("contours/mean/offsets", "type or shape");
}

// Records of others: another order, a gap, a member less.
TEST_F(FeatureTables, OtherRecordsAreRefused) {
  const std::function<void(hid_t)> layouts[] = {
      [](hid_t type) { H5Tinsert(type, "vertex", 0, H5T_STD_I64LE); },
      [](hid_t type) {
        std::size_t offset = 0;
        for (const RecordMember& member : kFeatureMembers) {
          const auto columns = static_cast<hsize_t>(member.columns);
          const bool wide = member.type == ElementType::int64;
          const hid_t number = wide ? H5T_STD_I64LE : H5T_IEEE_F32LE;
          const Hdf5Handle element(
              columns == 1 ? H5Tcopy(number) : H5Tarray_create2(number, 1, &columns), H5Tclose);
          H5Tinsert(type, member.name, offset, element.get());
          offset += H5Tget_size(element.get());
        }
      }};
  for (const auto& lay_out : layouts) {
    {
      const Hdf5Handle file(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                            H5Fclose);
      const Hdf5Handle type(H5Tcreate(H5T_COMPOUND, 64), H5Tclose);
      lay_out(type.get());
      const Hdf5Handle space = make_space(3, 1);
      const Hdf5Handle set(H5Dcreate2(file.get(), "/t", type.get(), space.get(), H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                           H5Dclose);
      ASSERT_GE(set.get(), 0);
    }
    try {
      Hdf5File::open(path_).open_array("/t");
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_NE(error.problem().find("element type"), std::string::npos) << error.what();
    }
  }
}

TEST_F(FeatureTables, TheWriterRefusesWhatDoesNotFit) {
  const EncodedFeatures right = encode_features(sample(), Compression::none);
  const EncodedArray nothing;
  std::vector<EncodedFeatures> wrong(7, right);
  wrong[0].of_kind[0] = nothing;
  wrong[1].of_kind[3] = right.of_kind[2];  // 14 features for 16 maxima
  wrong[2].contours[0].points = right.contours[1].points;
  wrong[3].contours[0].torsion = right.contours[1].torsion;
  wrong[4].contours[0].offsets = right.contours[1].offsets;
  wrong[5].contours[0].closed = right.contours[1].closed;
  wrong[6].contours[0].maxima = right.contours[1].maxima;
  for (const EncodedFeatures& features : wrong)
    EXPECT_THROW(write(features), std::invalid_argument);
}

}  // namespace
}  // namespace semigeo::io
