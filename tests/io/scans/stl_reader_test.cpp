#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using StlReader = ScanFileTest;

std::string facet(const std::string& last_vertex = "vertex 0 1 0.5") {
  return " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   " + last_vertex +
         "\n  endloop\n endfacet\n";
}

std::string solid(const std::string& facets) {
  return "solid a b c\n" + facets + "endsolid a b c\n";
}

std::string binary(const std::string& start, int triangles) {
  std::string file = start + std::string(80 - start.size(), ' ') + bytes_of(triangles);
  for (int i = 0; i < triangles; ++i) {
    file += bytes_of(std::nanf("")) + bytes_of(0.f) + bytes_of(1.f);  // normals are not looked at
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, static_cast<float>(i)})
      file += bytes_of(x);
    file += "ab";
  }
  return file;
}

TEST_F(StlReader, ReadsAsciiAsSoup) {
  const Scan scan = read("a.stl", solid(facet() + facet()));
  EXPECT_EQ(scan.format, "STL ascii");
  ASSERT_EQ(scan.mesh.points.size(), 6u);
  EXPECT_EQ(point(scan, 5), Eigen::Vector3d(0, 1, 0.5));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {3, 4, 5}}));
}

TEST_F(StlReader, AcceptsTheWaysAsciiIsWritten) {
  std::string upper = solid(facet());
  for (char& c : upper) c = static_cast<char>(std::toupper(c));
  std::string crlf;
  for (const char c : solid(facet())) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& file :
       {upper, crlf, facet(), "solid\n" + facet() + "endsolid", "\xef\xbb\xbf" + solid(facet()),
        "\n  " + solid(facet()), "solid \xe4\xf6\n" + facet() + "endsolid\n"}) {
    EXPECT_EQ(read("a.stl", file).mesh.triangles.size(), 1u) << file;
  }
  EXPECT_EQ(read("a.stl", solid(facet()) + solid(facet() + facet())).mesh.triangles.size(), 3u);
}

TEST_F(StlReader, AcceptsTheWordsAsWritersVaryThem) {
  std::string apart = solid(facet());
  for (const std::string word : {"loop", "facet", "solid"})
    apart.replace(apart.find("end" + word), 3 + word.size(), "end " + word);
  const std::string zero(1, '\0');
  for (const std::string& file :
       {apart, "solid x\n" + facet(), "solid x\n" + facet() + "solid y\n", solid(facet()) + "\x1a",
        solid(facet()) + zero + zero, solid("color 1 0 0\n" + facet()),
        "solid x\n# made by hand\n" + facet() + "// end\nendsolid\n"})
    EXPECT_EQ(read("a.stl", file).mesh.triangles.size(), 1u) << file;
}

TEST_F(StlReader, TheSizeDecidesWhereTheCountIsWrong) {
  std::string none = binary("", 3), too_many = binary("", 3);
  none.replace(80, 4, bytes_of(0));
  too_many.replace(80, 4, bytes_of(9));
  for (const std::string& file : {none, too_many}) {
    const Scan scan = read("a.stl", file);
    EXPECT_EQ(scan.mesh.triangles.size(), 3u);
    EXPECT_EQ(scan.wrong_counts, 1);
  }
  EXPECT_EQ(read("a.stl", binary("", 3)).wrong_counts, 0);
}

TEST_F(StlReader, SolidsBehindEachOtherAreAllRead) {
  const Scan scan = read("a.stl", binary("solid", 2) + binary("", 1) + binary("x", 3));
  ASSERT_EQ(scan.mesh.triangles.size(), 6u);
  EXPECT_EQ(point(scan, 8), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(scan.bytes_after_end, 0);
}

TEST_F(StlReader, ReadsBinaryWhateverItsHeaderSays) {
  for (const std::string start : {"", "solid", "solid by some CAD\nfacet normal", "\x1b"}) {
    for (const bool packed : {false, true}) {
      const std::string file = binary(start, 3);
      const Scan scan = packed ? read("a.stl.gz", gzip(file)) : read("a.stl", file);
      EXPECT_EQ(scan.format, packed ? "STL binary, gzip" : "STL binary");
      ASSERT_EQ(scan.mesh.points.size(), 9u);
      EXPECT_EQ(point(scan, 8), Eigen::Vector3d(0, 1, 2));
    }
  }
  EXPECT_EQ(read("a.stl.gz", gzip(solid(facet()))).format, "STL ascii, gzip");
  EXPECT_EQ(read("a.stl", binary("", 2) + "left over").bytes_after_end, 8);
}

TEST_F(StlReader, RefusesCutFiles) {
  const std::string whole = binary("solid", 2);
  expect_parts(error("a.stl", whole.substr(0, 150)),
               {"byte 150", "promises 2 triangles", "ends after 1"});
  expect_parts(error("a.stl.gz", gzip(whole.substr(0, 150))),
               {"byte 150", "promises 2", "after 1"});
  const std::string text = solid(facet());
  for (std::size_t size = 7; size < text.find("endfacet") + 8; ++size)
    EXPECT_NE(error("a.stl", text.substr(0, size)), "") << size;
  expect_parts(error("a.stl", "solid x\nfacet\n"), {"the file ends before its endfacet"});
}

TEST_F(StlReader, RefusesBadLines) {
  expect_parts(error("a.stl", solid(facet("vertex 0 x 0"))), {"line 6", "found 'x'"});
  expect_parts(error("a.stl", solid(facet("vertex 0 nan 0"))), {"line 6", "y coordinate"});
  expect_parts(error("a.stl", solid(facet("vertex 0 1"))), {"line 6", "the z coordinate"});
  expect_parts(error("a.stl", solid(facet(""))), {"line 7", "2 vertices in place of three"});
  expect_parts(error("a.stl", solid(facet("vertex 0 0 1\nvertex 1 1 1"))),
               {"line 8", "4 vertices"});
  expect_parts(error("a.stl", solid("hello\n")),
               {"line 2", "does not begin with facet or endsolid"});
  expect_parts(error("a.stl", solid("vertex 0 0 0\n")), {"line 2", "facet or endsolid"});
  expect_parts(error("a.stl", solid("facet\nvertex 0 0 0\n")), {"line 3", "outer loop"});
  expect_parts(error("a.stl", solid("facet\nouter loop\nendfacet\n")),
               {"line 4", "vertex or endloop"});
}

TEST_F(StlReader, DropsFacetsWithBadNumbers) {
  std::string file = binary("", 2);
  file.replace(84 + 50 + 12, 4, bytes_of(std::nanf("")));
  EXPECT_EQ(read("a.stl", file).faces_of_bad_vertices, 1);
  EXPECT_EQ(read("a.stl", file).mesh.triangles.size(), 1u);
  file.replace(84 + 12, 4, bytes_of(std::nanf("")));
  expect_parts(error("a.stl", file), {"byte 84", "x coordinate"});
}

TEST_F(StlReader, RefusesWhatIsNotStl) {
  expect_parts(error("a.stl", "hello"), {"no STL file"});
  expect_parts(error("a.stl", std::string(1000, 'x')),
               {"byte 1000", "promises 2021161080 triangles"});
  expect_parts(error("a.stl", solid("")), {"holds no vertices"});
  expect_parts(error("a.stl", binary("", 0)), {"holds no vertices"});
}

}  // namespace
}  // namespace semigeo::io
