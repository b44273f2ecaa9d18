#include <Eigen/Geometry>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using ObjReader = ScanFileTest;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST_F(ObjReader, ANameThatEndsInABackslashDoesNotSwallowTheNextLine) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const std::string name : {"usemtl C:\\scans\\", "mtllib a\\", "o \\", "g x \\"})
    EXPECT_EQ(read("a.obj", points + name + "\nf 1 2 3\n").mesh.triangles.size(), 1u) << name;
  EXPECT_EQ(read("a.obj", points + "f 1 \\\n2 3\n").mesh.triangles.size(), 1u);
}

TEST_F(ObjReader, OneBadVertexIsNotABadScan) {
  const Scan scan = read("a.obj",
                         "v 0 0 0\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv 1e40 0 0\nv inf 1 0\n"
                         "f 1 3 4\nf 1 2 3\nf 5 3 4\nf 1 3 4 2\n");
  EXPECT_EQ(scan.bad_vertices, 3);
  EXPECT_EQ(scan.faces_of_bad_vertices, 3);
  EXPECT_EQ(scan.mesh.triangles.size(), 2u);
  for (const Eigen::Vector3d& p : scan.mesh.points) EXPECT_TRUE(p.allFinite());
  expect_parts(error("a.obj", "v 0 0 0\nv nan 0 0\nv 1 0 0\nf 1 2 3\n"),
               {"line 2", "not a finite"});
}

TEST_F(ObjReader, ReadsEveryKindOfCorner) {
  const Scan scan =
      read("a.obj", "# comment\nmtllib a b.mtl\no part\n" + kSquare +
                        "vt 0 0\nvn 0 0 1\ng x y\nusemtl red\ns off\n"
                        "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 4/1/1\n"
                        "f -4 -3 -2\nf -4/-1/-1 3//-1 -1/1\nl 1 2\np 1\n");
  EXPECT_EQ(scan.format, "OBJ");
  EXPECT_EQ(scan.mesh.points.size(), 4u);
  EXPECT_EQ(scan.mesh.triangles,
            (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 2}, {0, 2, 3}}));
}

TEST_F(ObjReader, NormalsOfCornersAddUpAtTheirVertices) {
  const Scan scan = read("a.obj", kSquare +
                                      "vn 0 0 1\nvn 0 1 0\nvn x\nvn 1 0 0 # nan\n"
                                      "f 1//1 2/9/2 3//3\nf 1//-1 3 4//99\nf 1/2 2 4\n");
  using Eigen::Vector3f;
  ASSERT_EQ(scan.mesh.normals.size(), 4u);
  EXPECT_EQ(scan.mesh.normals[0], Vector3f(1, 0, 1));
  EXPECT_EQ(scan.mesh.normals[1], Vector3f(0, 1, 0));
  EXPECT_EQ(scan.mesh.normals[2], Vector3f::Zero());
  EXPECT_EQ(scan.mesh.normals[3], Vector3f::Zero());
  EXPECT_TRUE(read("a.obj", kSquare + "f 1 2 3\n").mesh.normals.empty());
}

TEST_F(ObjReader, IgnoresColoursAndWeights) {
  const Scan scan =
      read("a.obj", "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv\t0 1  0.5 nan\nf 1 2 3 # end\n");
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0.5));
}

TEST_F(ObjReader, NegativeNumbersCountFromTheirLine) {
  const Scan scan = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {1, 2, 3}}));
  expect_parts(error("b.obj", "v 0 0 0\nv 1 0 0\nf -3 -2 -1\nv 0 1 0\n"),
               {"line 3", "vertex -3", "only 2 vertices stand above it"});
}

TEST_F(ObjReader, FacesMayPrecedeTheirVertices) {
  const Scan scan = read("a.obj", "v 0 0 0\nf 1 2 3\nf 1 2 3 4\nv 1 0 0\nv 1 1 0\nv 0 1 0\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  expect_parts(error("b.obj", "f 1 2 3\nf 1 2 9\nf 1 3 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
               {"line 2", "vertex 9", "only 3 vertices", "numbered from 1"});
}

TEST_F(ObjReader, JoinsContinuedLines) {
  const Scan scan = read("a.obj",
                         "v 0 0 \\\n 0\nv 1 0 0\\\r\nv 9\nv 0 1 0\nvt 0.5 \\\n0.5\n"
                         "# not continued \\\nf 1 \\\n2 \\\n 3\n");
  EXPECT_EQ(scan.mesh.points.size(), 3u);
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  expect_parts(error("b.obj", "v 0 \\\n0 \\\nx\n"),
               {"line 3", "expected the z coordinate, found 'x'"});
}

TEST_F(ObjReader, CutsConcavePolygonsInside) {
  // An arrow head: the fan from its first corner would leave it.
  const Scan scan = read("a.obj", "v 0 2 0\nv -1 0 0\nv 0 1 0\nv 1 0 0\nf 2 3 4 1\n");
  double area = 0;
  for (const auto& [a, b, c] : scan.mesh.triangles) {
    const double twice =
        (point(scan, b) - point(scan, a)).cross(point(scan, c) - point(scan, a)).z();
    EXPECT_GT(twice, 0);
    area += twice / 2;
  }
  EXPECT_DOUBLE_EQ(area, 1);
  EXPECT_EQ(scan.polygons_triangulated, 1);
}

TEST_F(ObjReader, AcceptsAnyLineEndAndAMissingLast) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string file = "v 0 0 0" + end + "v 1 0 0" + end + end + "v 0 1 0" + end + "f 1 2 3";
    EXPECT_EQ(read("a.obj", file).mesh.triangles.size(), 1u);
    EXPECT_EQ(read("b.obj", "\xef\xbb\xbf" + file).mesh.triangles.size(), 1u);
  }
}

TEST_F(ObjReader, CountsShortFaces) {
  const Scan scan = read("a.obj", kSquare + "f 1 2 3\nf 1 2\nf 1\nf\n");
  EXPECT_EQ(scan.faces_skipped, 3);
  expect_parts(error("b.obj", kSquare + "f 1 2 3\nf 1 5\n"), {"line 6", "vertex 5"});
}

TEST_F(ObjReader, RefusesBadLines) {
  expect_parts(error("a.obj", "v 0 0\nv 1 0 0\n"), {"line 1", "the z coordinate should be"});
  expect_parts(error("a.obj", "v 0 0 zero\n"), {"line 1", "found 'zero'"});
  expect_parts(error("a.obj", "v 0 0 1.#IND\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
               {"line 1", "z coordinate", "finite"});
  expect_parts(error("a.obj", kSquare + "f 0 1 2\n"), {"line 5", "vertex 0", "counts from 1"});
  expect_parts(error("a.obj", kSquare + "f 1 2 a\n"), {"line 5", "not v, v/vt"});
  expect_parts(error("a.obj", kSquare + "f 1 2 3.5\n"), {"line 5", "not v, v/vt"});
  expect_parts(error("a.obj", kSquare + "f 1 2 99999999999999999999\n"), {"line 5", "not v"});
  expect_parts(error("a.obj", kSquare + "f 1 2 9223372036854775807\n"), {"line 5", "limit"});
  expect_parts(error("a.obj", kSquare + "f 1 2 -9223372036854775808\n"),
               {"line 5", "-9223372036854775808"});
  expect_parts(error("a.obj", "v 0 0 0\n\x01\x02\n"), {"line 2", "keyword"});
  expect_parts(
      error("a.obj", "v 0 0 0\ng " + std::string(3'000'000, 'x') + "\nv 1 0 0\n" + "f 1 2 x\n"),
      {"line 4"});
  expect_parts(error("a.obj", std::string(10'000, 'x') + "\n"), {"line 1", "longer than 4096"});
  std::string face = kSquare + "f";
  for (int i = 0; i < 65'536; ++i) face += " 1";
  expect_parts(error("a.obj", face), {"line 5", "more than 65535 corners"});
}

TEST_F(ObjReader, RefusesScansWithoutASurface) {
  expect_parts(error("a.obj", kSquare), {"4 points but no faces"});
  expect_parts(error("a.obj", "# nothing\n"), {"holds no vertices"});
  expect_parts(error("a.obj", "hello world\n"), {"holds no vertices"});
}

}  // namespace
}  // namespace semigeo::io
