#include "io/dataset/dataset.hpp"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "io/hdf5/hdf5_library.hpp"
#include "tests/io/dataset/sample_dataset.hpp"
#include "tests/support/equal_features.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

using tests::Sample;
using tests::SampleLevel;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::set<std::string> names_in(const tests::TemporaryFolder& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    names.insert(entry.path().filename().string());
  return names;
}

template <typename Row>
std::vector<float> flat(const std::vector<Row>& rows) {
  std::vector<float> result;
  for (const Row& row : rows) result.insert(result.end(), row.data(), row.data() + 3);
  return result;
}

class DatasetRoundTrip : public ::testing::TestWithParam<std::tuple<bool, Compression>> {
 protected:
  Sample sample() const {
    return {.changing = std::get<0>(GetParam()), .compression = std::get<1>(GetParam())};
  }
};

TEST_P(DatasetRoundTrip, EverythingComesBack) {
  const tests::TemporaryFolder folder;
  const std::string digest = tests::write_sample(folder / "s.vtkhdf", sample());
  EXPECT_EQ(names_in(folder), (std::set<std::string>{"s.vtkhdf", "s.xdmf"}));

  const Dataset dataset(folder / "s.vtkhdf");
  EXPECT_NO_THROW(dataset.verify());
  EXPECT_EQ(dataset.digest(), digest);
  EXPECT_EQ(dataset.level_count(), 3);
  EXPECT_FALSE(dataset.creator_version().empty());
  const DatasetHeader wanted = tests::sample_header();
  const DatasetHeader& header = dataset.header();
  EXPECT_EQ(header.parameters, wanted.parameters);
  EXPECT_EQ(header.input_name, wanted.input_name);
  EXPECT_EQ(header.input_xxh3, wanted.input_xxh3);
  EXPECT_EQ(header.job_key, wanted.job_key);
  EXPECT_EQ(header.length_unit, wanted.length_unit);
  EXPECT_EQ(header.repairs, wanted.repairs);
  EXPECT_EQ(header.preparation, wanted.preparation);
  EXPECT_EQ(header.origin, wanted.origin);

  const Selection selection = dataset.selection();
  EXPECT_EQ(selection.feature_counts, (std::vector<std::int64_t>{0, 26, 52}));
  EXPECT_EQ(selection.smoothed, (std::vector<double>{0.5, 26.5, 52.5}));
  EXPECT_EQ(selection.level, 2);
  EXPECT_EQ(selection.chosen, sample().changing ? Chosen::kOption : Chosen::kSlope);

  for (int k = 0; k < 3; ++k) {
    const SampleLevel level = tests::sample_level(sample(), k);
    const LevelInfo info = dataset.level(k);
    EXPECT_EQ(info.iteration, level.attributes.iteration);
    EXPECT_EQ(info.step, level.attributes.step);
    EXPECT_EQ(info.scale, level.attributes.scale);
    EXPECT_EQ(info.mean_edge_length, level.attributes.mean_edge_length);
    EXPECT_EQ(info.parts, level.attributes.parts);
    EXPECT_EQ(info.shortest_side, level.attributes.shortest_side);
    for (const LevelCount& count : kLevelCounts)
      EXPECT_EQ(info.remeshed.*count.count, level.attributes.remeshed.*count.count) << count.name;
    EXPECT_EQ(info.vertices, sample().vertices_of(k));
    EXPECT_EQ(info.triangles, sample().triangles_of(k));
    EXPECT_EQ(dataset.read_floats(k, "points"), flat(level.points));
    EXPECT_EQ(dataset.read_floats(k, "normals"), flat(level.normals));
    EXPECT_EQ(dataset.read_floats(k, "gaussian_curvature"), level.gaussian_curvature);
    EXPECT_EQ(dataset.read_floats(k, "mean_curvature"), level.mean_curvature);
    EXPECT_EQ(dataset.read_floats(k, "patch_completeness"), level.patch_completeness);
    const auto wide = [](const auto& v) { return std::vector<std::int64_t>(v.begin(), v.end()); };
    EXPECT_EQ(dataset.read_integers(k, "source_vertex"), wide(level.source_vertex));
    EXPECT_EQ(dataset.read_integers(k, "part"), wide(level.part));
    std::vector<std::int64_t> corners;
    for (const auto& triangle : level.triangles)
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    EXPECT_EQ(dataset.read_integers(k, "triangles"), corners);
    EXPECT_EQ(dataset.scale(k), info.scale);
    EXPECT_TRUE(dataset.read_features(k) == level.features.of_kind);
    for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
      EXPECT_EQ(info.features.of_kind[kind], k * (5 + kind));
    for (int kind = 0; kind < kContourKinds; ++kind) {
      EXPECT_TRUE(dataset.read_contours(k, kernels::FeatureKind(kind)) ==
                  level.features.contours[kind]);
      EXPECT_EQ(info.features.contours[kind], k * (2 + kind));
      EXPECT_EQ(info.features.contour_length[kind], level.features.contours[kind].length);
    }
  }
}

TEST_P(DatasetRoundTrip, SameCallsGiveTheSameBytes) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf", sample());
  mallopt(M_PERTURB, 0xA5);  // from now on forgotten bytes would differ
  tests::write_sample(folder / "b.vtkhdf", sample());
  mallopt(M_PERTURB, 0);
  EXPECT_TRUE(read_file(folder / "a.vtkhdf") == read_file(folder / "b.vtkhdf"));
}

std::string sample_name(const ::testing::TestParamInfo<std::tuple<bool, Compression>>& sample) {
  return std::string(std::get<0>(sample.param) ? "changing" : "same") +
         (std::get<1>(sample.param) == Compression::kNone ? "_none" : "_deflate");
}

INSTANTIATE_TEST_SUITE_P(All, DatasetRoundTrip,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(Compression::kNone,
                                                              Compression::kDeflate)),
                         sample_name);

TEST(Dataset, DigestIsOfTheContentNotOfTheLayout) {
  const tests::TemporaryFolder folder;
  const std::string packed = tests::write_sample(folder / "a.vtkhdf");
  EXPECT_EQ(packed, tests::write_sample(folder / "b.vtkhdf", {.compression = Compression::kNone}));
  EXPECT_NE(packed, tests::write_sample(folder / "c.vtkhdf", {.levels = 2}));
  EXPECT_NE(packed, tests::write_sample(folder / "d.vtkhdf", {.triangles = 9001}));
}

TEST(Dataset, LevelsShareConnectivityWithoutStoringItAgain) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf");
  const Hdf5File file = Hdf5File::open(folder / "a.vtkhdf");
  for (const std::string name : {"/triangles", "/source_vertex", "/part"})
    EXPECT_EQ(file.address("/levels/000" + name), file.address("/levels/002" + name));
}

// A file in which one occurrence of `from` reads `to`.
void change(const std::filesystem::path& path, const std::string& from, const std::string& to) {
  std::string content = read_file(path);
  const std::size_t at = content.find(from);
  ASSERT_NE(at, std::string::npos);
  content.replace(at, to.size(), to);
  write_file(path, content);
}

std::string failure_of_verify(const std::filesystem::path& path) {
  try {
    Dataset(path).verify();
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path);
    return error.what();
  }
  return "none";
}

TEST(Dataset, VerifyNamesTheArrayWhoseBytesChanged) {
  const tests::TemporaryFolder folder;
  const Sample sample;
  tests::write_sample(folder / "whole.vtkhdf", sample);
  const SampleLevel level = tests::sample_level(sample, 1);
  const auto fields = tests::encode_fields(level, sample.compression);
  const auto shared =
      tests::encode_connectivity(tests::sample_level(sample, 0), sample.compression);
  const std::pair<const EncodedArray*, std::string> arrays[] = {
      {&fields.points, "/levels/001/points"},
      {&fields.gaussian_curvature, "/levels/001/gaussian_curvature"},
      {&shared.triangles, "/levels/000/triangles"},
      {&shared.source_vertex, "/levels/000/source_vertex"},
      {&fields.features.features, "/levels/001/features"},
      {&fields.features.contour_points, "/levels/001/contour_points"},
  };
  for (const auto& [array, name] : arrays) {
    std::filesystem::copy_file(folder / "whole.vtkhdf", folder / "broken.vtkhdf",
                               std::filesystem::copy_options::overwrite_existing);
    const std::vector<std::byte>& chunk = array->chunks.back().bytes;
    const std::string from(reinterpret_cast<const char*>(chunk.data()), chunk.size());
    std::string to = from;
    to[to.size() / 2] = static_cast<char>(to[to.size() / 2] ^ 1);
    change(folder / "broken.vtkhdf", from, to);
    const std::string message = failure_of_verify(folder / "broken.vtkhdf");
    const std::string place = array->shape.compact ? name + ": " : name + ", chunk ";
    EXPECT_NE(message.find(place), std::string::npos) << message;
    EXPECT_NE(message.find("checksum"), std::string::npos) << message;
  }
}

TEST(Dataset, VerifyComparesTheDigest) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf");
  {
    // HDF5's own checksums are right again.
    const Hdf5Handle file(H5Fopen((folder / "a.vtkhdf").c_str(), H5F_ACC_RDWR, H5P_DEFAULT),
                          H5Fclose);
    const Hdf5Handle attribute(H5Aopen(file.get(), "job_key", H5P_DEFAULT), H5Aclose);
    const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose);
    ASSERT_GE(H5Awrite(attribute.get(), type.get(), "key-of-a-thief"), 0);
  }
  const std::string message = failure_of_verify(folder / "a.vtkhdf");
  EXPECT_NE(message.find("attribute digest"), std::string::npos) << message;
}

TEST(Dataset, DamagedNamesAndAttributesAreFound) {
  const tests::TemporaryFolder folder;
  for (const auto& [from, to] : {std::pair{"key-of-the-job", "key-of-a-thief"},
                                 {"mean_curvature", "mean_curvaturf"},
                                 {"ConnectivityIdOffsets", "ConnectivityIdOffsetz"},
                                 {"/levels/001/normals", "/levels/002/normals"}}) {
    tests::write_sample(folder / "a.vtkhdf", {.vertices = 100, .triangles = 100});
    change(folder / "a.vtkhdf", from, to);
    const std::string message = failure_of_verify(folder / "a.vtkhdf");
    EXPECT_NE(message.find("checksum"), std::string::npos) << from << ": " << message;
    EXPECT_NE(message.find("run with --verify"), std::string::npos) << message;
  }
}

TEST(Dataset, TruncatedFilesAreRefused) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf", {.vertices = 100, .triangles = 100});
  const std::string whole = read_file(folder / "a.vtkhdf");
  for (const double part : {0.0, 0.01, 0.3, 0.9, 0.999}) {
    write_file(folder / "b.vtkhdf",
               whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    EXPECT_NE(failure_of_verify(folder / "b.vtkhdf"), "none") << part;
    EXPECT_THROW(read_origin(folder / "b.vtkhdf"), Error) << part;
  }
}

TEST(Dataset, OtherFilesAreRefusedWithAReason) {
  const tests::TemporaryFolder folder;
  Hdf5File::create(folder / "other.h5").close();
  EXPECT_NE(failure_of_verify(folder / "other.h5").find("not a semigeo dataset"),
            std::string::npos);
  Hdf5File future = Hdf5File::create(folder / "future.h5");
  future.write_attribute("/", "format", "semigeo-dataset");
  future.write_attribute("/", "format_version", kDatasetFormatVersion + 1);
  future.close();
  EXPECT_NE(failure_of_verify(folder / "future.h5")
                .find("format " + std::to_string(kDatasetFormatVersion + 1)),
            std::string::npos);
  Hdf5File torn = Hdf5File::create(folder / "torn.h5");
  torn.write_attribute("/", "format", "semigeo-dataset");
  torn.write_attribute("/", "format_version", kDatasetFormatVersion);
  torn.write_attribute("/", "job_key", "key");
  torn.close();
  EXPECT_NE(failure_of_verify(folder / "torn.h5").find("not written to its end"),
            std::string::npos);
  EXPECT_THROW(read_origin(folder / "torn.h5"), Error);
}

TEST(Dataset, JobKeyOfCompleteFilesOnly) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf");
  write_file(folder / "text.vtkhdf", "text");
  EXPECT_EQ(read_origin(folder / "a.vtkhdf").job_key, "key-of-the-job");
  EXPECT_EQ(read_origin(folder / "a.vtkhdf").input_xxh3, tests::sample_header().input_xxh3);
  EXPECT_THROW(read_origin(folder / "missing.vtkhdf"), Error);
  EXPECT_THROW(read_origin(folder / "missing.vtkhdf"), Error);
  EXPECT_THROW(read_origin(folder / "text.vtkhdf"), Error);
  EXPECT_THROW(read_origin(folder.path()), Error);
}

TEST(Dataset, AsksForWhatExists) {
  const tests::TemporaryFolder folder;
  tests::write_sample(folder / "a.vtkhdf", {.vertices = 10, .triangles = 10});
  const Dataset dataset(folder / "a.vtkhdf");
  EXPECT_THROW(dataset.level(3), Error);
  EXPECT_THROW(dataset.level(-1), Error);
  EXPECT_THROW(dataset.read_floats(0, "triangles"), Error);
  EXPECT_THROW(dataset.read_floats(0, "torsion"), Error);
  EXPECT_THROW(dataset.read_integers(0, "points"), Error);
  EXPECT_THROW(dataset.read_features(3), Error);
  EXPECT_THROW(dataset.scale(3), Error);
  EXPECT_THROW(dataset.read_contours(3, kernels::FeatureKind::kMean), Error);
  EXPECT_THROW(dataset.read_contours(0, kernels::FeatureKind::kMeanTorsion), std::invalid_argument);
}

TEST(DatasetWriter, UnfinishedLeavesNothing) {
  const tests::TemporaryFolder folder;
  {
    DatasetWriter writer(folder / "a.vtkhdf", tests::sample_header(), Compression::kDeflate);
    writer.write_connectivity(
        tests::encode_connectivity(tests::sample_level({}, 0), Compression::kDeflate));
    EXPECT_EQ(names_in(folder).size(), 1U);
    EXPECT_EQ(names_in(folder).count("a.vtkhdf"), 0U);
  }
  EXPECT_TRUE(names_in(folder).empty());
}

TEST(DatasetWriter, RefusesWhatDoesNotFit) {
  const tests::TemporaryFolder folder;
  const Compression none = Compression::kNone;
  const SampleLevel level = tests::sample_level({.vertices = 10, .triangles = 8}, 0);
  const SampleLevel longer = tests::sample_level({.vertices = 11, .triangles = 8}, 0);
  DatasetWriter writer(folder / "a.vtkhdf", tests::sample_header(), none);
  EXPECT_THROW(writer.finish(), std::invalid_argument);
  EXPECT_THROW(writer.write_level(level.attributes, tests::encode_fields(level, none)),
               std::invalid_argument);
  writer.write_connectivity(tests::encode_connectivity(level, none));
  EXPECT_THROW(writer.write_connectivity(tests::encode_connectivity(level, none)),
               std::invalid_argument);
  EXPECT_THROW(writer.finish(), std::invalid_argument);
  EXPECT_THROW(writer.write_level(level.attributes, tests::encode_fields(longer, none)),
               std::invalid_argument);
}

TEST(DatasetWriter, RefusesASelectionThatDoesNotFit) {
  const tests::TemporaryFolder folder;
  const Compression none = Compression::kNone;
  const SampleLevel level = tests::sample_level({.vertices = 10, .triangles = 8}, 1);
  const Selection right = {.feature_counts = {26}, .smoothed = {26}};
  DatasetWriter writer(folder / "a.vtkhdf", tests::sample_header(), none);
  EXPECT_THROW(writer.write_selection({}), std::invalid_argument);
  writer.write_connectivity(tests::encode_connectivity(level, none));
  EXPECT_THROW(writer.write_selection(right), std::invalid_argument);
  writer.write_level(level.attributes, tests::encode_fields(level, none));
  EXPECT_THROW(writer.finish(), std::invalid_argument);
  Selection wrong = right;
  wrong.feature_counts = {25};
  EXPECT_THROW(writer.write_selection(wrong), std::invalid_argument);
  wrong = right;
  wrong.smoothed = {};
  EXPECT_THROW(writer.write_selection(wrong), std::invalid_argument);
  for (const std::int64_t beyond : {-1, 1}) {
    wrong = right;
    wrong.level = beyond;
    EXPECT_THROW(writer.write_selection(wrong), std::invalid_argument);
  }
  writer.write_selection(right);
  EXPECT_THROW(writer.write_selection(right), std::invalid_argument);
  EXPECT_THROW(writer.write_connectivity(tests::encode_connectivity(level, none)),
               std::invalid_argument);
  EXPECT_NO_THROW(writer.finish());
}

TEST(DatasetWriter, ScalesMustGrow) {
  const tests::TemporaryFolder folder;
  const SampleLevel level = tests::sample_level({.vertices = 10, .triangles = 8}, 0);
  DatasetWriter writer(folder / "a.vtkhdf", tests::sample_header(), Compression::kNone);
  writer.write_connectivity(tests::encode_connectivity(level, Compression::kNone));
  writer.write_level(level.attributes, tests::encode_fields(level, Compression::kNone));
  EXPECT_THROW(
      writer.write_level(level.attributes, tests::encode_fields(level, Compression::kNone)), Error);
}

TEST(DatasetWriter, AFullDiskAtAnyMomentIsAnErrorAndLeavesNothing) {
  const tests::TemporaryFolder folder;
  const Sample sample{.levels = 2, .vertices = 300, .triangles = 500};
  tests::write_sample(folder / "a.vtkhdf", sample);
  const auto size = static_cast<rlim_t>(std::filesystem::file_size(folder / "a.vtkhdf"));
  std::filesystem::remove(folder / "a.vtkhdf");
  std::filesystem::remove(folder / "a.xdmf");
  for (rlim_t bytes = 0; bytes < size; bytes += size / 40) {
    const tests::FileSizeLimit limit(bytes);
    try {
      tests::write_sample(folder / "a.vtkhdf", sample);
      ADD_FAILURE() << "no error with " << bytes << " of " << size << " bytes";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), folder / "a.vtkhdf");
      EXPECT_NE(error.problem().find("File too large"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(names_in(folder).empty());
  }
  EXPECT_NO_THROW(tests::write_sample(folder / "a.vtkhdf", sample));
}

}  // namespace
}  // namespace semigeo::io
