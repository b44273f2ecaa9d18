#include "io/dataset/feature_tables.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <stdexcept>
#include <tuple>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/hdf5/array_reader.hpp"
#include "io/hdf5/hdf5_library.hpp"
#include "tests/io/dataset/sample_dataset.hpp"
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

class FeatureTablesTest : public ::testing::Test {
 protected:
  void write(const LevelFeatures& features, Compression compression = Compression::kDeflate) {
    write(encode_features(tables_of(features), compression));
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
      read_features(file, kLevel, kVertices);
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
  /// What is refused when one value of the tables is wrong.
  void expect_refused(const std::function<void(FeatureTables&)>& change, const std::string& place,
                      const std::string& problem) {
    FeatureTables tables = tables_of(sample());
    change(tables);
    write(encode_features(tables, Compression::kNone));
    expect_refused(place, problem);
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.h5";
  std::string digest_;
};

TEST_F(FeatureTablesTest, EverythingComesBack) {
  LevelFeatures many = sample();
  for (int i = 0; i < 10'000; ++i) many.of_kind[0].push_back(many.of_kind[1][i % 7]);
  LevelFeatures none;
  for (kernels::SampledContours& contours : none.contours) contours.offsets = {0};
  for (const Compression compression : {Compression::kNone, Compression::kDeflate})
    for (const LevelFeatures& features : {sample(), many, none}) {
      write(features, compression);
      const Hdf5File file = Hdf5File::open(path_);
      EXPECT_EQ(content_digest(file), digest_);
      const FeatureCounts counts = check_features(file, kLevel);
      EXPECT_TRUE(read_features(file, kLevel, kVertices) == features.of_kind);
      for (int kind = 0; kind < kernels::kFeatureKinds; ++kind) {
        const auto& wanted = features.of_kind[kind];
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

TEST_F(FeatureTablesTest, OtherReadersSeeTheSameRecords) {
  LevelFeatures features = sample();
  for (int i = 0; i < 10'000; ++i) features.of_kind[1].push_back(features.of_kind[0][i % 9]);
  const std::size_t rows = 10'000 + 10 + 12 + 14 + 16;
  for (const Compression compression : {Compression::kNone, Compression::kDeflate}) {
    write(features, compression);
    const Hdf5File file = Hdf5File::open(path_);
    EXPECT_GT(file.open_array("/level/features").shape().chunk_count(), 1);
    EXPECT_TRUE(file.shape_of("/level/contours").compact);
    for (const auto& [table, type, size] :
         {std::tuple("/level/features", ElementType::kFeature, 72 * rows),
          std::tuple("/level/contours", ElementType::kContour, std::size_t{24 * 10})}) {
      const std::vector<std::byte> ours = read_records(file, table, type);
      EXPECT_EQ(ours.size(), size);
      EXPECT_EQ(ours, file.read_through_library(table));
    }
  }
}

TEST_F(FeatureTablesTest, TheTypeOfARecordHasItsMembers) {
  for (const ElementType type : {ElementType::kFeature, ElementType::kContour}) {
    std::string text;
    for (const RecordMember& member : members_of(type)) {
      text += (text.empty() ? "{" : ",") + std::string(member.name) + ":" +
              std::string(name_of(member.type));
      if (member.columns > 1) text += "[" + std::to_string(member.columns) + "]";
    }
    EXPECT_EQ(name_of(type), text + "}");
  }
}

TEST_F(FeatureTablesTest, TheDigestHasALineWithThatType) {
  const std::vector<FeatureRow> features = tables_of(sample()).features;
  const EncodedArray encoded = encode_array(array_of(features), Compression::kDeflate);
  DigestedFile file(Hdf5File::create(path_));
  file.write_array("/t", encoded);
  const std::vector<std::uint64_t> hashes = {encoded.chunks.at(0).raw_xxh3};
  std::array<char, 17> hash;
  std::snprintf(hash.data(), hash.size(), "%016llx",
                static_cast<unsigned long long>(xxh3_64(std::as_bytes(std::span(hashes)))));
  std::ofstream(folder_ / "lines") << "dataset /t " << name_of(ElementType::kFeature) << " "
                                   << features.size() << " " << hash.data() << "\ngroup /\n";
  EXPECT_EQ(file.digest().hex(), xxh3_of_file(folder_ / "lines"));
}

// Of 10, 12, 14 and 16 features row 41 is the sixth of mean_torsion.
TEST_F(FeatureTablesTest, VerticesMustExist) {
  for (const std::int64_t vertex : {std::int64_t{-1}, kVertices})
    expect_refused([&](auto& t) { t.features[41].vertex = vertex; }, "features",
                   "row 41 is at vertex " + std::to_string(vertex) + " of 40");
}

TEST_F(FeatureTablesTest, RowsMustBeOfTheKindThatIsCounted) {
  expect_refused([](auto& t) { t.features[10].kind = 0; }, "features",
                 "row 10 is of kind 0 among those of kind 1");
  expect_refused([](auto& t) { t.contours[3].kind = 1; }, "contours",
                 "row 3 is of kind 1 among those of kind 0");
}

// K = 0 has 4 contours with 18 points, H = 0 has 6 with 33.
TEST_F(FeatureTablesTest, ContoursMustFollowOneAnother) {
  expect_refused([](auto& t) { t.contours[0].first = 1; }, "contours",
                 "contour 0 begins at point 1 instead of 0");
  expect_refused([](auto& t) { --t.contours[4].first; }, "contours",
                 "contour 4 begins at point 17 instead of 18");
  expect_refused([](auto& t) { t.contours[5].count = 0; }, "contours", "contour 5 has 0 points");
  expect_refused([](auto& t) { ++t.contours[9].count; }, "contours", "contour 9 has 9 points of 8");
  expect_refused([](auto& t) { --t.contours[9].count; }, "contours", "end at point 50 of 51");
}

TEST_F(FeatureTablesTest, MarksAndMaximaMustMeanSomething) {
  expect_refused([](auto& t) { t.contours[2].closed = 2; }, "contours", "marked neither 0 nor 1");
  expect_refused([](auto& t) { t.features[22].contour_point = -1; }, "features",
                 "row 22 is at point -1, outside its contours");
  expect_refused([](auto& t) { t.features[22].contour_point = 18; }, "features", "point 18,");
  expect_refused([](auto& t) { t.features[36].contour_point = 17; }, "features", "point 17,");
  expect_refused([](auto& t) { t.features[36].contour_point = 51; }, "features", "point 51,");
}

// Removes an object, or puts the array /other in its place.
void replace(const std::filesystem::path& path, const std::string& name, bool by_other) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  ASSERT_GE(H5Ldelete(file.get(), name.c_str(), H5P_DEFAULT), 0);
  if (by_other)
    ASSERT_GE(H5Lmove(file.get(), "/other", file.get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
}

TEST_F(FeatureTablesTest, ShapesAndTypesMustFit) {
  const FeatureTables tables = tables_of(sample());
  const EncodedFeatures right = encode_features(tables, Compression::kNone);
  const auto encoded = [](const auto& rows) {
    return encode_array(array_of(std::span(rows)), Compression::kNone);
  };
  const std::pair<std::string, EncodedArray> wrong[] = {
      {"features", encoded(std::vector<float>(52))},
      {"features", encoded(tables.contours)},
      {"features", encoded(std::span(tables.features).first(51))},
      {"contours", encoded(tables.features)},
      {"contours", encoded(std::span(tables.contours).first(9))},
      {"contour_points", encoded(std::vector<float>(51))},
      {"contour_points", encoded(std::vector<Eigen::Vector3f>(51))}};
  write(right);
  EXPECT_EQ(failure(), "");
  for (const auto& [name, array] : wrong) {
    write(right, [&](Hdf5File& file) { file.write_array("/other", array); });
    replace(path_, std::string(kLevel) + "/" + name, true);
    expect_refused(name, "has not the ");
  }
}

TEST_F(FeatureTablesTest, TablesMayNotBeMissing) {
  const EncodedFeatures right = encode_features(tables_of(sample()), Compression::kNone);
  for (const std::string name : {"features", "contours", "contour_points"}) {
    write(right);
    replace(path_, kLevel + ("/" + name), false);
    EXPECT_NE(failure().find(kLevel + ("/" + name)), std::string::npos) << failure();
  }
}

TEST_F(FeatureTablesTest, TheCountsMustBeThoseOfTheTables) {
  using Counts = std::vector<std::int64_t>;
  const std::tuple<const char*, Counts, const char*> wrong[] = {
      {"feature_counts", {10, 12, 14, 17}, "/features: has not the rows"},
      {"feature_counts", {10, 12, 14, 15}, "/features: has not the rows"},
      {"feature_counts", {-10, 32, 14, 16}, "/features: has not the rows"},
      {"contour_counts", {4, 7}, "/contours: has not the rows"}};
  for (const auto& [name, counts, problem] : wrong) {
    write(encode_features(tables_of(sample()), Compression::kNone));
    {
      const Hdf5Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
      const Hdf5Handle group(H5Oopen(file.get(), kLevel, H5P_DEFAULT), H5Oclose);
      const Hdf5Handle attribute(H5Aopen(group.get(), name, H5P_DEFAULT), H5Aclose);
      ASSERT_GE(H5Awrite(attribute.get(), H5T_STD_I64LE, counts.data()), 0);
    }
    EXPECT_NE(failure().find(problem), std::string::npos) << failure();
  }
}

// Records of others: another order, a gap, a member less.
TEST_F(FeatureTablesTest, OtherRecordsAreRefused) {
  const std::function<void(hid_t)> layouts[] = {
      [](hid_t type) { H5Tinsert(type, "vertex", 0, H5T_STD_I64LE); },
      [](hid_t type) {
        std::size_t offset = 0;
        for (const RecordMember& member : kFeatureMembers) {
          const auto columns = static_cast<hsize_t>(member.columns);
          const bool wide = member.type == ElementType::kInt64;
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

TEST_F(FeatureTablesTest, TheWriterRefusesWhatDoesNotFit) {
  const EncodedFeatures right = encode_features(tables_of(sample()), Compression::kNone);
  std::vector<EncodedFeatures> wrong(6, right);
  wrong[0].features = {};
  wrong[1].contours = {};
  wrong[2].contour_points = {};
  wrong[2].contour_points.shape.columns = 3;
  wrong[3].counts.of_kind[2] += 1;
  wrong[4].counts.contours[0] += 1;
  std::swap(wrong[5].features, wrong[5].contours);
  for (const EncodedFeatures& features : wrong)
    EXPECT_THROW(write(features), std::invalid_argument);
  LevelFeatures features = sample();
  features.of_kind[3].pop_back();  // 15 features for 16 maxima
  EXPECT_THROW(tables_of(features), std::invalid_argument);
}

}  // namespace
}  // namespace semigeo::io
