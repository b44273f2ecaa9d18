#include "jobs/report/scan_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "io/files/file_digest.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Decodes base64 without a table: slow, and unlike the encoder.
template <typename Number>
std::vector<Number> decoded(const nlohmann::json& json) {
  const auto text = json.get<std::string>();
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

class ScanReportTest : public testing::Test {
 protected:
  fs::path make_dataset(const kernels::TriangleMesh& mesh, int levels = 2) {
    const fs::path scan = tests::write_obj(folder_ / "scan.obj", mesh);
    SurfaceJob job;
    job.input = scan;
    job.input_name = "scan.obj";
    job.output = folder_ / "scan.obj.vtkhdf";
    job.input_xxh3 = io::xxh3_of_file(scan);
    engine::Workers workers(1);
    engine::Observer observer;
    run_surface_job(job, {.levels = levels}, {workers, observer, {}});
    return job.output;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(ScanReportTest, PointsAndCurvaturesAreThoseOfTheDataset) {
  const io::Dataset dataset(make_dataset(shapes::icosphere(3)));
  const nlohmann::json document = scan_report(dataset);
  ASSERT_EQ(document["levels"].size(), 3);
  for (int k = 0; k < 3; ++k) {
    const nlohmann::json& level = document["levels"][k];
    const std::vector<float> points = dataset.read_floats(k, "points");
    const auto shown = decoded<std::uint16_t>(level["points"]);
    ASSERT_EQ(shown.size(), points.size());
    const float size = level["size"];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float low = level["low"][i % 3];
      EXPECT_NEAR(low + size * shown[i] / 65535, points[i], size / 65535);
    }
    EXPECT_EQ(decoded<float>(level["H"]), dataset.read_floats(k, "mean_curvature"));
    EXPECT_EQ(decoded<float>(level["K"]), dataset.read_floats(k, "gaussian_curvature"));
    EXPECT_EQ(decoded<std::uint16_t>(level["triangles"]).size(),
              3 * level["triangle_count"].get<std::size_t>());
    // A unit sphere.
    EXPECT_NEAR(level["limits"]["K"].get<double>(), 1, 0.1);
    EXPECT_NEAR(level["limits"]["H"].get<double>(), 1, 0.1);
  }
}

TEST_F(ScanReportTest, ALargeLevelIsDecimatedWithItsFields) {
  const io::Dataset dataset(make_dataset(shapes::icosphere(3)));
  const nlohmann::json document = scan_report(dataset, {.vertices = 200});
  const nlohmann::json& level = document["levels"][0];
  EXPECT_EQ(level["vertices"], 642);
  EXPECT_EQ(level["shown_vertices"], 200);
  const auto rows = decoded<std::int32_t>(level["rows"]);
  const auto shown = decoded<float>(level["H"]);
  ASSERT_EQ(rows.size(), 200);
  ASSERT_EQ(shown.size(), 200);
  const std::vector<float> mean = dataset.read_floats(0, "mean_curvature");
  for (std::size_t v = 0; v < rows.size(); ++v) EXPECT_EQ(shown[v], mean[rows[v]]);
  // Euler: a closed surface of V vertices has 2 V - 4 triangles.
  EXPECT_EQ(decoded<std::uint16_t>(level["triangles"]).size(), 3 * (2 * 200 - 4));
}

TEST_F(ScanReportTest, OfManyLevelsSomeAreShown) {
  const io::Dataset dataset(make_dataset(shapes::icosphere(2), 9));
  const nlohmann::json document = scan_report(dataset, {.levels = 3});
  EXPECT_EQ(document["level_count"], 10);
  std::vector<int> levels;
  for (const nlohmann::json& level : document["levels"]) levels.push_back(level["level"]);
  EXPECT_LE(levels.size(), 4u);
  EXPECT_TRUE(std::ranges::is_sorted(levels));
  EXPECT_EQ(levels.front(), 0);
  EXPECT_EQ(levels.back(), 9);
  EXPECT_EQ(std::ranges::count(levels, document["level"].get<int>()), 1);
}

TEST_F(ScanReportTest, EveryValidVertexIsInAHistogram) {
  const io::Dataset dataset(make_dataset(shapes::icosphere(3)));
  const nlohmann::json document = scan_report(dataset);
  for (const nlohmann::json& level : document["levels"]) {
    for (const char* field : {"K", "H"}) {
      std::int64_t count = 0;
      for (const std::int64_t bin : level["histograms"][field]) count += bin;
      EXPECT_EQ(count,
                level["vertices"].get<std::int64_t>() - level["invalid"].get<std::int64_t>());
    }
    // A sphere, on which H has one sign, and outwards.
    const auto bins = level["histograms"]["H"].get<std::vector<std::int64_t>>();
    const auto half = bins.begin() + std::ssize(bins) / 2;
    EXPECT_EQ(std::count(half, bins.end(), 0), std::ssize(bins) / 2);
  }
  EXPECT_EQ(document["scales"].size(), 3);
}

}  // namespace
}  // namespace semigeo::jobs
