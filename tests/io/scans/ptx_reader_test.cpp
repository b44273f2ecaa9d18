#include <Eigen/Geometry>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using PtxReader = ScanFileTest;

/// The header of a cloud of 2 columns and 3 rows that was turned by 90 degrees about z and moved.
const std::string kHeader =
    "2\n3\n10 20 30\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n10 20 30 1\n";
const std::string kPoints =
    "0.5 -0.5 -5 0.5 10 20 30\n0.5 0.5 -5 0.5 10 20 30\n0 0 0 0.5 0 0 0\n"
    "1.5 -0.5 -5 0.5 10 20 30\n1.5 0.5 -5 0.5 10 20 30\n1.5 1.5 -5 0.5 10 20 30\n";

TEST_F(PtxReader, PutsACloudIntoTheCommonFrame) {
  const Scan scan = read("a.ptx", kHeader + kPoints);
  EXPECT_EQ(scan.format, "PTX");
  ASSERT_EQ(scan.mesh.points.size(), 5u);
  EXPECT_EQ(point(scan, 0), Eigen::Vector3d(10.5, 20.5, 25));  // (x, y) becomes (-y, x)
  EXPECT_EQ(point(scan, 4), Eigen::Vector3d(8.5, 21.5, 25));
  EXPECT_EQ(scan.eye, Eigen::Vector3d(10, 20, 30));
  ASSERT_EQ(scan.mesh.triangles.size(), 3u);
  for (const auto& t : scan.mesh.triangles) {  // towards the scanner, which is above
    const Eigen::Vector3d a = point(scan, t[0]);
    EXPECT_GT((point(scan, t[1]) - a).cross(point(scan, t[2]) - a).z(), 0);
  }
}

/// The eye of a cloud whose header leaves the scanner at zero is the origin of its frame.
TEST_F(PtxReader, KnowsTheEyeFromTheMatrix) {
  std::string text = kHeader + kPoints;
  text.replace(text.find("10 20 30"), 8, "0 0 0");
  EXPECT_EQ(read("a.ptx", text).eye, Eigen::Vector3d(10, 20, 30));
}

TEST_F(PtxReader, ReadsSeveralClouds) {
  const std::string second =
      "2\n2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"
      "0 0 -4 1\n0 1 -4 1\n1 0 -4 1\n1 1 -4 1\n";
  const Scan scan = read("a.ptx", kHeader + kPoints + second);
  EXPECT_EQ(scan.mesh.points.size(), 9u);
  EXPECT_EQ(scan.mesh.triangles.size(), 5u);
  EXPECT_EQ(point(scan, 8), Eigen::Vector3d(1, 1, -4));
  EXPECT_FALSE(scan.eye);
  EXPECT_EQ(read("b.ptx.gz", gzip(kHeader + kPoints + second)).mesh.triangles.size(), 5u);
}

TEST_F(PtxReader, RefusesWhatIsWrong) {
  expect_parts(error("a.ptx", "// NVIDIA\n"), {"line 1", "expected the number of columns"});
  expect_parts(error("b.ptx", "0\n3\n"), {"line 1", "number of columns is not in 1"});
  expect_parts(error("c.ptx", "2\n3\n1 2\n"), {"line 3", "ends where the scanner's position"});
  expect_parts(error("d.ptx", "2\n3\n1 2 3 4\n"), {"line 3", "more than the scanner's position"});
  expect_parts(error("e.ptx", kHeader.substr(0, kHeader.size() - 11)),
               {"ends where a row of the matrix"});
  expect_parts(error("f.ptx", kHeader + "1 2 3 4\n1 2 3 4\n"),
               {"promises 6 points, but the file ends after 2"});
  expect_parts(error("g.ptx", kHeader + "1 2\n"), {"line 11", "line ends where the z coordinate"});
  std::string nothing;
  for (int i = 0; i < 6; ++i) nothing += "0 0 0 0.5\n";
  expect_parts(error("h.ptx", kHeader + nothing), {"holds no vertices"});
}

}  // namespace
}  // namespace semigeo::io
