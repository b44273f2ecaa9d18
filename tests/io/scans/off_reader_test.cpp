#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using OffReader = ScanFileTest;

const std::string kBody = "0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2\n";

TEST_F(OffReader, ReadsEveryHeader) {
  for (const std::string start :
       {"OFF\n3 1 0\n", "OFF3 1 0\n", "off\n3 1 0\n", "OFF\n3\n1\n0\n\n", "OFF 3 1 3\n",
        "OFF\n3 1\n", "3 1 0\n", "# comment\nOFF # comment\n\n# x\n3 1 0 # n\n\n",
        "\xef\xbb\xbfOFF\r\n3 1 0\r\n"}) {
    const Scan scan = read("a.off", start + kBody);
    EXPECT_EQ(scan.format, "OFF");
    EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0.5));
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  }
}

TEST_F(OffReader, ValuesMayStandOnLinesOfTheirOwn) {
  const Scan scan = read("a.off", "OFF 3 1 0\n0\n0 0\n1 0\n\n0\n0 1 # y\n0.5\n3\n0\n1 2\n");
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0.5));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
}

TEST_F(OffReader, TheNumberOfEdgesMayStandAloneOrBeAbsent) {
  const std::string body = "7 8 9\n1 0 0\n0 1 0\n3 0 1 2";
  for (const std::string counts :
       {"3\n1\n0\n", "3 1\n0\n", "3\n1 0\n", "3 1 0\n", "3 1\n", "3\n1\n\n# x\n"}) {
    const Scan scan = read("a.off", "OFF\n" + counts + body);
    EXPECT_EQ(point(scan, 0), Eigen::Vector3d(7, 8, 9)) << counts;
    EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1, 0, 0)) << counts;
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  }
}

TEST_F(OffReader, IgnoresWhatThePrefixesAdd) {
  for (const std::string keyword : {"COFF", "NOFF", "CNOFF", "NCOFF", "STOFF", "STCNOFF", "OFF"}) {
    const Scan scan = read("a.off", keyword +
                                        "\n3 1 0\n0 0 0 9 9 9\n1 0 0 0.5 0.5\n0 1 0 1 1 1 0\n"
                                        "3 0 1 2 255 0 0 # red\n");
    EXPECT_EQ(scan.format, keyword);
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  }
}

std::string binary(const std::string& keyword, int extra_floats) {
  const auto put = [](auto value) { return bytes_of(value, std::endian::big); };
  std::string file = keyword + " BINARY\n" + put(4) + put(2) + put(0);
  for (int i = 0; i < 4; ++i) {
    file += put(static_cast<float>(i)) + put(static_cast<float>(i * i)) + put(0.5f);
    for (int k = 0; k < extra_floats; ++k) file += put(9.0f);
  }
  file += put(3) + put(0) + put(1) + put(2) + put(4) + put(1.f) + put(1.f) + put(1.f) + put(1.f);
  file += put(4) + put(0) + put(1) + put(2) + put(3) + put(0);
  return file;
}

TEST_F(OffReader, ReadsBinary) {
  for (const auto& [keyword, extra] :
       {std::pair{"OFF", 0}, {"NOFF", 3}, {"COFF", 4}, {"CNOFF", 7}, {"STOFF", 2}}) {
    const Scan scan = read("a.off", binary(keyword, extra));
    EXPECT_EQ(scan.format, keyword + std::string(" binary"));
    EXPECT_EQ(point(scan, 3), Eigen::Vector3d(3, 9, 0.5));
    EXPECT_EQ(scan.mesh.triangles.size(), 3u);
    EXPECT_EQ(scan.mesh.triangles[0], (std::array<std::int32_t, 3>{0, 1, 2}));
  }
}

TEST_F(OffReader, ReadsNormals) {
  const auto normals = [&](const std::string& keyword, const std::string& vertices) {
    return read("a.off", keyword + "\n3 1 0\n" + vertices + "3 0 1 2\n").mesh.normals;
  };
  using Eigen::Vector3f;
  for (const auto& found :
       {normals("NOFF", "0 0 0 0 0 2\n1 0 0 0 0 1\n0 1 0 0 1 0\n"),
        normals("NOFF", "0 0 0\n0 0 2\n1 0 0\n0 0 1\n0 1 0\n0 1\n0\n"),
        normals("CNOFF", "0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 255 0 0\n0 1 0 0 1 0 0 0 0\n")}) {
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].normalized(), Vector3f(0, 0, 1));
    EXPECT_EQ(found[2], Vector3f(0, 1, 0));
  }
  EXPECT_TRUE(normals("CNOFF", "0 0 0 255 0 0 0 0 1\n1 0 0 9 0 0\n0 1 0\n").empty())
      << "the colours stand first";
  EXPECT_TRUE(normals("OFF", "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n").empty());
  EXPECT_EQ(read("a.off", binary("NOFF", 3)).mesh.normals.at(3), Vector3f(9, 9, 9));
  EXPECT_TRUE(read("a.off", binary("COFF", 4)).mesh.normals.empty());
}

TEST_F(OffReader, DividesHomogeneousCoordinates) {
  EXPECT_EQ(point(read("a.off", "4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 8 2 4\n3 0 1 2\n"), 2),
            Eigen::Vector3d(0, 2, 0.5));
  EXPECT_EQ(point(read("a.off", binary("4OFF", 1)), 3), Eigen::Vector3d(3, 9, 0.5) / 9);
  expect_parts(error("a.off", "4OFF\n3 1 0\n0 0 0 1\n2 0 0 0\n0 8 2 4\n3 0 1 2\n"),
               {"line 4", "x coordinate is not a finite number"});
}

TEST_F(OffReader, RefusesCutBinaryFiles) {
  const std::string whole = binary("OFF", 0);
  for (std::size_t size = 12; size < whole.size(); ++size)
    expect_parts(error("a.off", whole.substr(0, size)),
                 {size == 12 ? "" : "byte " + std::to_string(size)});
  expect_parts(error("a.off", whole.substr(0, 40)), {"promises 4 vertices", "ends after 1"});
  std::string negative = whole;
  negative[11] = '\xff';
  expect_parts(error("a.off", negative), {"byte 11", "negative count"});
}

TEST_F(OffReader, RefusesOtherDimensionsAndOtherFiles) {
  for (const std::string keyword : {"nOFF", "CnOFF", "4nOFF"})
    expect_parts(error("a.off", keyword + "\n3 1 0\n"), {"line 1", "three dimensions"});
  expect_parts(error("a.off", "ply\n"), {"the file is a PLY file"});
  expect_parts(error("a.off", "SOFF\n"), {"line 1", "not an OFF file"});
  expect_parts(error("a.off", "# only this"), {"nothing but comments"});
}

TEST_F(OffReader, RefusesBadValuesWithTheirLine) {
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0\nx 1 0\n3 0 1 2\n"),
               {"line 5", "the z coordinate"});
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n"),
               {"line 4", "y coordinate"});
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
               {"line 6", "vertex 3"});
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
               {"the file ends where a vertex index"});
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-1\n"), {"line 6", "negative"});
  expect_parts(error("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n99999 1\n"), {"line 6", "65535"});
  expect_parts(error("a.off", "OFF\n3 x 0\n"), {"line 2", "number of faces, found 'x'"});
  expect_parts(error("a.off", "OFF\n-3 1 0\n"), {"line 2", "negative count"});
  expect_parts(error("a.off", "OFF\n"), {"the file ends where the number of vertices"});
}

TEST_F(OffReader, RefusesAPromiseThatTheFileDoesNotKeep) {
  expect_parts(error("a.off", "OFF\n1000000000000 1 0\n0 0 0\n1 0 0\n"),
               {"promises 1000000000000 vertices", "ends after 2"});
  expect_parts(error("a.off", "OFF\n3 1000000000000 0\n" + kBody),
               {"promises 1000000000000 faces", "ends after 1"});
}

TEST_F(OffReader, RefusesScansWithoutASurface) {
  expect_parts(error("a.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n"), {"2 points but no faces"});
  expect_parts(error("a.off", "OFF\n0 0 0\n"), {"holds no vertices"});
}

}  // namespace
}  // namespace semigeo::io
