#include "io/scans/feature_writer.hpp"

#include <iterator>

#include "tests/io/scans/scan_files.hpp"
#include "tests/support/file_size_limit.hpp"

namespace semigeo::io {
namespace {

using kernels::Feature;
using kernels::FeatureKind;
using kernels::SampledContours;

constexpr std::array<double, 3> kNear = {0, 0, 0};
constexpr std::array<double, 3> kFar = {4.5e6, 0, 0.125};

class FeatureWriter : public ::testing::Test {
 protected:
  std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Bytes of a point at its origin.
  std::string placed(const Eigen::Vector3f& point, const std::array<double, 3>& origin) {
    std::string bytes;
    for (int axis = 0; axis < 3; ++axis)
      bytes += origin == kNear ? bytes_of(point[axis]) : bytes_of(point[axis] + origin[axis]);
    return bytes;
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "out";
  std::vector<Feature> maxima_ = {{.vertex = 7,
                                   .value = -0.1F,
                                   .prominence = 3,
                                   .position = {1, 0.5F, -2},
                                   .initial_position = {1, 0.25F, -3},
                                   .normal = {0, 0, 1},
                                   .scale_free_gaussian = 1e-20F,
                                   .scale_free_mean = 16777216}};
  std::vector<Feature> torsion_ = {{.vertex = 2}, {.vertex = 3}};
  std::vector<FeaturesView> tables_ = {{FeatureKind::kMean, maxima_},
                                       {FeatureKind::kMeanTorsion, torsion_}};
  // Open, closed, closed of two points, a single point.
  SampledContours contours_ = {.points = {{0, 0, 0},
                                          {1, 0, 0},
                                          {2, 0, 0},
                                          {0, 1, 0},
                                          {1, 1, 0},
                                          {0.1F, 2, 0},
                                          {5, 5, 0},
                                          {6, 6, 0},
                                          {7, 7, 0}},
                               .torsion = {0, 1, 2, 3, 4, 5, 6, 7, -0.5F},
                               .offsets = {0, 3, 6, 8, 9},
                               .closed = {0, 1, 1, 1},
                               .maxima = {},
                               .length = 0};
};

TEST_F(FeatureWriter, FeaturesAsPlyByteByByte) {
  for (const auto& origin : {kNear, kFar}) {
    write_features_ply(path_, tables_, origin);
    const std::string real = origin == kNear ? "float" : "double";
    std::string expected =
        "ply\nformat binary_little_endian 1.0\ncomment written by semigeo\nelement vertex 3\n";
    for (const char* name : {"x", "y", "z"}) expected += "property " + real + " " + name + "\n";
    expected +=
        "property float nx\nproperty float ny\nproperty float nz\n"
        "property float value\nproperty float prominence\n"
        "property float scale_free_gaussian\nproperty float scale_free_mean\n";
    for (const char* name : {"initial_x", "initial_y", "initial_z"})
      expected += "property " + real + " " + name + "\n";
    expected += "property uchar kind\nproperty int vertex\nend_header\n";
    for (const FeaturesView& table : tables_)
      for (const Feature& f : table.features) {
        expected += placed(f.position, origin) + placed(f.normal, kNear) + bytes_of(f.value) +
                    bytes_of(f.prominence) + bytes_of(f.scale_free_gaussian) +
                    bytes_of(f.scale_free_mean) + placed(f.initial_position, origin);
        expected += static_cast<char>(table.kind);
        expected += bytes_of(static_cast<std::int32_t>(f.vertex));
      }
    EXPECT_EQ(content(path_), expected);
  }
}

TEST_F(FeatureWriter, FeaturesAsCsvInShortestDecimals) {
  const std::string names =
      "x,y,z,nx,ny,nz,value,prominence,scale_free_gaussian,scale_free_mean,"
      "initial_x,initial_y,initial_z,kind,vertex\n";
  write_features_csv(path_, std::span(tables_).first(1), kNear);
  EXPECT_EQ(content(path_), names + "1,0.5,-2,0,0,1,-0.1,3,1e-20,16777216,1,0.25,-3,mean,7\n");
  write_features_csv(path_, tables_, kFar);
  EXPECT_EQ(content(path_),
            names +
                "4500001,0.5,-1.875,0,0,1,-0.1,3,1e-20,16777216,4500001,0.25,-2.875,mean,7\n"
                "4500000,0,0.125,0,0,0,0,0,0,0,4500000,0,0.125,mean_torsion,2\n"
                "4500000,0,0.125,0,0,0,0,0,0,0,4500000,0,0.125,mean_torsion,3\n");
  write_features_csv(path_, {}, kNear);
  EXPECT_EQ(content(path_), names);
}

TEST_F(FeatureWriter, ContoursAsPlyByteByByte) {
  for (const auto& origin : {kNear, kFar}) {
    write_contours_ply(path_, contours_, origin);
    const std::string real = origin == kNear ? "float" : "double";
    std::string expected =
        "ply\nformat binary_little_endian 1.0\ncomment written by semigeo\nelement vertex 9\n";
    for (const char* name : {"x", "y", "z"}) expected += "property " + real + " " + name + "\n";
    expected +=
        "property float torsion\nproperty int contour\nproperty uchar closed\n"
        "element edge 6\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    const std::int32_t contour_of[] = {0, 0, 0, 1, 1, 1, 2, 2, 3};
    for (std::size_t p = 0; p < 9; ++p) {
      expected += placed(contours_.points[p], origin) + bytes_of(contours_.torsion[p]) +
                  bytes_of(contour_of[p]);
      expected += contour_of[p] == 0 ? '\0' : '\1';
    }
    for (const auto& [from, to] : {std::pair(0, 1), {1, 2}, {3, 4}, {4, 5}, {5, 3}, {6, 7}})
      expected += bytes_of(from) + bytes_of(to);
    EXPECT_EQ(content(path_), expected);
  }
}

TEST_F(FeatureWriter, ContoursAsCsv) {
  write_contours_csv(path_, contours_, kNear);
  EXPECT_EQ(content(path_),
            "x,y,z,torsion,contour,closed\n0,0,0,0,0,0\n1,0,0,1,0,0\n2,0,0,2,0,0\n0,1,0,3,1,1\n"
            "1,1,0,4,1,1\n0.1,2,0,5,1,1\n5,5,0,6,2,1\n6,6,0,7,2,1\n7,7,0,-0.5,3,1\n");
  SampledContours none;
  none.offsets = {0};
  write_contours_csv(path_, none, kFar);
  EXPECT_EQ(content(path_), "x,y,z,torsion,contour,closed\n");
}

TEST_F(FeatureWriter, RefusesWhatDoesNotFit) {
  std::vector<SampledContours> wrong(5, contours_);
  wrong[0].torsion.pop_back();
  wrong[1].closed.pop_back();
  wrong[2].offsets = {1, 3, 6, 8, 9};
  wrong[3].offsets = {0, 6, 3, 8, 9};
  wrong[4].offsets = {0, 3, 6, 8, 8};
  for (const SampledContours& contours : wrong) {
    EXPECT_THROW(write_contours_ply(path_, contours, kNear), std::invalid_argument);
    EXPECT_THROW(write_contours_csv(path_, contours, kNear), std::invalid_argument);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(FeatureWriter, NumbersBeyondAPlysIntAreForCsv) {
  maxima_[0].vertex = std::int64_t{1} << 31;
  write_file(path_, "before");
  EXPECT_THROW(write_features_ply(path_, tables_, kNear), Error);
  EXPECT_EQ(content(path_), "before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
  write_features_csv(path_, tables_, kNear);
  EXPECT_NE(content(path_).find(",2147483648\n"), std::string::npos);
}

TEST_F(FeatureWriter, ReportsAFullDisk) {
  maxima_.resize(3'000, maxima_[0]);
  tables_[0].features = maxima_;
  for (const auto write : {write_features_ply, write_features_csv}) {
    std::string problem;
    try {
      const tests::FileSizeLimit limit(4096);
      write(path_, tables_, kNear);
    } catch (const Error& failure) {
      problem = failure.problem();
    }
    expect_parts(problem, {"cannot be written"});
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  }
}

}  // namespace
}  // namespace semigeo::io
