#include "bench/peers/range_grid.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "io/files/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::peers {
namespace {

/// Returns a grid of rays over z = 0, one unit apart, that all met something.
RangeGrid flat_grid(std::int64_t rows, std::int64_t columns) {
  RangeGrid grid{rows, columns, {}, {}};
  for (std::int64_t r = 0; r < rows; ++r)
    for (std::int64_t c = 0; c < columns; ++c) {
      grid.cells.push_back(static_cast<std::int32_t>(grid.points.size()));
      grid.points.emplace_back(c, -r, 0);
    }
  return grid;
}

double area_towards_z(const kernels::TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.points[t[0]];
    area += (mesh.points[t[1]] - p).cross(mesh.points[t[2]] - p).z() / 2;
  }
  return area;
}

TEST(RangeGrid, TrianglesCoverTheGridAndFaceTheScanner) {
  const kernels::TriangleMesh mesh = triangulated(flat_grid(4, 6));
  EXPECT_EQ(mesh.triangles.size(), 2 * 3 * 5);
  EXPECT_DOUBLE_EQ(area_towards_z(mesh), 15);
  RangeGrid upside_down = flat_grid(4, 6);
  for (Eigen::Vector3d& p : upside_down.points) p.y() = -p.y();
  EXPECT_DOUBLE_EQ(area_towards_z(triangulated(upside_down)), 15);
}

TEST(RangeGrid, ThreeRaysGiveOneTriangleAndTwoNone) {
  for (int gap = 0; gap < 4; ++gap) {
    RangeGrid grid = flat_grid(2, 2);
    grid.cells[gap] = -1;
    const kernels::TriangleMesh mesh = triangulated(grid);
    ASSERT_EQ(mesh.triangles.size(), 1) << gap;
    EXPECT_DOUBLE_EQ(area_towards_z(mesh), 0.5);
    for (const std::int32_t corner : mesh.triangles[0]) EXPECT_NE(corner, gap);
    grid.cells[(gap + 1) % 4] = -1;
    EXPECT_TRUE(triangulated(grid).triangles.empty());
  }
}

TEST(RangeGrid, TheShorterDiagonalIsTaken) {
  for (const std::int32_t lifted : {0, 1}) {
    RangeGrid grid = flat_grid(2, 2);
    grid.points[lifted].z() = 0.5;  // Its diagonal is the longer one.
    int triangles_at_lifted = 0;
    for (const auto& t : triangulated(grid).triangles)
      triangles_at_lifted += static_cast<int>(std::ranges::count(t, lifted));
    EXPECT_EQ(triangles_at_lifted, 1);
  }
}

TEST(RangeGrid, NoTriangleJoinsTwoSurfaces) {
  RangeGrid grid = flat_grid(4, 6);
  for (Eigen::Vector3d& p : grid.points)
    if (p.x() > 2.5) p.z() = -5;
  const kernels::TriangleMesh mesh = triangulated(grid);
  EXPECT_EQ(mesh.triangles.size(), 2 * 3 * 4);
  EXPECT_EQ(triangulated(grid, 10).triangles.size(), 2 * 3 * 5);
}

class RangeGridFile : public testing::Test {
 protected:
  RangeGrid read(const std::string& rays) {
    const std::filesystem::path path = folder_.path() / "grid.ply";
    std::ofstream(path) << "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 2\n"
                           "element vertex 4\nproperty float x\nproperty float y\n"
                           "property float z\nelement range_grid 6\n"
                           "property list uchar int vertex_indices\nend_header\n"
                           "0 0 0\n1 0 0.5\n0 -1 0\n1 -1 0\n"
                        << rays;
    return read_range_grid(path);
  }

  tests::TemporaryFolder folder_;
};

TEST_F(RangeGridFile, IsRead) {
  const RangeGrid grid = read("1 0\n1 1\n0\n1 2\n1 3\n0\n");
  EXPECT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.columns, 3);
  ASSERT_EQ(grid.points.size(), 4);
  EXPECT_EQ(grid.points[1], Eigen::Vector3d(1, 0, 0.5));
  EXPECT_EQ(grid.cells, (std::vector<std::int32_t>{0, 1, -1, 2, 3, -1}));
}

TEST_F(RangeGridFile, WithoutAllRaysOrWithWrongOnesIsRefused) {
  EXPECT_THROW(read("1 0\n1 1\n0\n"), io::Error);
  EXPECT_THROW(read("1 0\n1 4\n0\n1 2\n1 3\n0\n"), io::Error);
  EXPECT_THROW(read("1 0\n2 1 2\n0\n1 2\n1 3\n0\n"), io::Error);
  EXPECT_THROW(read("1 0\n1 -1\n0\n1 2\n1 3\n0\n"), io::Error);
}

}  // namespace
}  // namespace semigeo::peers
