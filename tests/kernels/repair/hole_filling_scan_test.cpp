// A real scan with noise and holes, where it is at hand, against the scan that it was made from.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "kernels/repair/decimation.hpp"
#include "kernels/repair/hole_filling.hpp"
#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/nearest_surface.hpp"

namespace semigeo::kernels {
namespace {

const std::filesystem::path kScans = SEMIGEO_REAL_SCANS;

/// Binary little-endian PLY of float x, y, z and triangles, and nothing else.
TriangleMesh read_ply(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  while (std::getline(file, line) && line != "end_header") {
    if (line.starts_with("element vertex")) vertices = std::stoul(line.substr(15));
    if (line.starts_with("element face")) faces = std::stoul(line.substr(13));
  }
  TriangleMesh mesh;
  for (std::size_t v = 0; v < vertices; ++v) {
    Eigen::Vector3f p;
    file.read(reinterpret_cast<char*>(p.data()), sizeof(p));
    mesh.points.push_back(p.cast<double>());
  }
  for (std::size_t f = 0; f < faces; ++f) {
    std::array<std::int32_t, 3> t{};
    file.ignore(1);
    file.read(reinterpret_cast<char*>(t.data()), sizeof(t));
    mesh.triangles.push_back(t);
  }
  EXPECT_TRUE(file.good()) << path;
  return mesh;
}

TriangleMesh read_obj(const std::filesystem::path& path) {
  std::ifstream file(path);
  TriangleMesh mesh;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Eigen::Vector3d p;
      words >> p.x() >> p.y() >> p.z();
      mesh.points.push_back(p);
    } else if (kind == "f") {
      std::array<std::int32_t, 3> t{};
      for (std::int32_t& v : t) {
        std::string corner;
        words >> corner;
        v = std::stoi(corner) - 1;
      }
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

class HoleFillingScanTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kScans / "syn_skull_noisy_holes.ply"))
      GTEST_SKIP() << "no scans in " << kScans;
    noisy_ = build_surface(read_ply(kScans / "syn_skull_noisy_holes.ply")).surface;
    clean_ = build_surface(read_obj(kScans / "os_skull.obj")).surface;
  }

  Surface noisy_;
  Surface clean_;
};

TEST_F(HoleFillingScanTest, AllHolesOfTheSkullAreFilled) {
  const FilledSurface filled = fill_holes(noisy_, 200);
  // Cutting the holes left islands of a few faces in them; those keep their outlines.
  EXPECT_EQ(filled.counts.unsplittable, 0);
  EXPECT_EQ(filled.counts.too_long, 0);
  EXPECT_GE(filled.counts.filled, 12);
  const auto left = boundary_loops(filled.surface);
  EXPECT_EQ(static_cast<std::int64_t>(left.size()), filled.counts.outer);
  for (const auto& loop : left) EXPECT_NE(loop.part, 0);

  const NearestSurface nearest(clean_);
  const double noise = distances(nearest, noisy_.points).mean();
  const auto patches = std::span(filled.surface.points).subspan(noisy_.vertex_count());
  ASSERT_GT(patches.size(), 500u);
  EXPECT_LT(distances(nearest, patches).mean(), 1.5 * noise);
  EXPECT_LT(distances(nearest, filled.surface.points).mean(), 1.01 * noise);
}

TEST_F(HoleFillingScanTest, TheFilledSkullCanBeDecimated) {
  const FilledSurface filled = fill_holes(noisy_, 200);
  const double tolerance = 0.2 * mean_edge_length(filled.surface);
  const DecimatedSurface result = decimate(filled.surface, {.tolerance = tolerance});
  EXPECT_LE(result.distance.maximum, 1.0001 * tolerance);
  EXPECT_LT(result.surface.vertex_count(), 0.9 * static_cast<double>(noisy_.vertex_count()));
  EXPECT_EQ(result.surface.part_count, filled.surface.part_count);
}

}  // namespace
}  // namespace semigeo::kernels
