#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using PlyReader = ScanFileTest;

std::string header(const std::string& encoding, const std::string& declarations) {
  return "ply\nformat " + encoding + " 1.0\n" + declarations + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kTriangle =
    "element vertex 3\n" + kXyz + "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kTriangleBody = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST_F(PlyReader, ReadsAscii) {
  const Scan scan =
      read("a.ply", header("ascii", kTriangle) + "0 0 0\n1.5 0 -2e-1\n0 +1. .5\n3 0 1 2\n");
  EXPECT_EQ(scan.format, "PLY ascii");
  ASSERT_EQ(scan.mesh.points.size(), 3u);
  EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1.5, 0, -0.2));
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0.5));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(scan.polygons_triangulated, 0);
  EXPECT_EQ(scan.faces_skipped, 0);
}

TEST_F(PlyReader, ReadsNormals) {
  const std::string list = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string body = "0 0 0 0 0 1\n1 0 0 0 nan 1\n0 1 0 0 0 -2\n3 0 1 2\n";
  const Scan scan = read("a.ply", header("ascii", "element vertex 3\n" + kXyz +
                                                      "property float nx\nproperty float ny\n"
                                                      "property float nz\n" +
                                                      list) +
                                      body);
  ASSERT_EQ(scan.mesh.normals.size(), 3u);
  EXPECT_EQ(scan.mesh.normals[0], Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(scan.mesh.normals[1], Eigen::Vector3f::Zero());
  EXPECT_EQ(scan.mesh.normals[2], Eigen::Vector3f(0, 0, -2));
  EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1, 0, 0));
  // Two parts of a normal are none.
  EXPECT_TRUE(read("a.ply", header("ascii", "element vertex 3\n" + kXyz +
                                                "property float nx\nproperty float ny\n"
                                                "property float c\n" +
                                                list) +
                                body)
                  .mesh.normals.empty());
}

TEST_F(PlyReader, ReadsBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const bool little = order == std::endian::little;
    std::string file = header(little ? "binary_little_endian" : "binary_big_endian", kTriangle);
    for (const float x : {0.f, 0.f, 0.f, 1.5f, 0.f, -2.f, 0.f, 1.f, 3.f})
      file += bytes_of(x, order);
    file += '\3';
    for (const std::int32_t i : {2, 0, 1}) file += bytes_of(i, order);
    const Scan scan = read("a.ply", file);
    EXPECT_EQ(scan.format, little ? "PLY binary little endian" : "PLY binary big endian");
    EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1.5, 0, -2));
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{2, 0, 1}}));
  }
}

/// Every type in one vertex, the coordinates last and in another order, lists between them.
std::string everything_header(const std::string& encoding, bool sized_names) {
  const auto name = [&](const char* plain, const char* sized) {
    return std::string(sized_names ? sized : plain);
  };
  return header(encoding,
                "comment end_header is not here\nobj_info made by hand\n"
                "element camera 2\nproperty " +
                    name("double", "float64") +
                    " focus\n"
                    "property list " +
                    name("ushort", "uint16") + " " + name("short", "int16") +
                    " rows\n"
                    "element nothing 1000000000000\n"
                    "element vertex 3\n"
                    "property " +
                    name("uchar", "uint8") +
                    " red\n"
                    "property " +
                    name("int", "int32") +
                    " z\n"
                    "property list " +
                    name("char", "int8") + " " + name("float", "float32") +
                    " extra\n"
                    "property " +
                    name("short", "int16") +
                    " y\n"
                    "property " +
                    name("double", "float64") +
                    " x\n"
                    "element face 2\nproperty " +
                    name("ushort", "uint16") +
                    " colour\n"
                    "property list " +
                    name("uint", "uint32") + " " + name("ushort", "uint16") +
                    " vertex_index\nproperty list uchar float texcoord\n");
}

void expect_everything(const Scan& scan) {
  ASSERT_EQ(scan.mesh.points.size(), 3u);
  EXPECT_EQ(point(scan, 0), Eigen::Vector3d(0.25, -1, 100000));
  EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1.25, -2, 100001));
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(2.25, -3, 100002));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 0}}));
}

TEST_F(PlyReader, SkipsWhatItDoesNotNeedInAscii) {
  for (const bool sized : {false, true}) {
    expect_everything(read("a.ply", everything_header("ascii", sized) +
                                        "1.5 3 7 8 9\n2.5 0\n"
                                        "255 100000 2 0.5 nan -1 0.25\n"
                                        "0 100001 0 -2 1.25\n"
                                        "9 100002 1 7 -3 2.25\n"
                                        "7 3 0 1 2 0\n8 3 2 1 0 2 0.5 0.5\n"));
  }
}

TEST_F(PlyReader, SkipsWhatItDoesNotNeedInBinary) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto put = [&](auto value) { return bytes_of(value, order); };
    std::string file = everything_header(
        order == std::endian::little ? "binary_little_endian" : "binary_big_endian", true);
    file += put(1.5) + put(std::uint16_t{2}) + put(std::int16_t{7}) + put(std::int16_t{8});
    file += put(2.5) + put(std::uint16_t{0});
    for (int i = 0; i < 3; ++i) {
      file +=
          put(std::uint8_t{200}) + put(std::int32_t{100000 + i}) + put(static_cast<std::int8_t>(i));
      for (int k = 0; k < i; ++k) file += put(1.0f);
      file += put(static_cast<std::int16_t>(-1 - i)) + put(0.25 + i);
    }
    for (const bool turned : {false, true}) {
      file += put(std::uint16_t{9}) + put(std::uint32_t{3});
      for (const int i : {turned ? 2 : 0, 1, turned ? 0 : 2})
        file += put(static_cast<std::uint16_t>(i));
      file += put(std::uint8_t{1}) + put(0.5f);
    }
    expect_everything(read("a.ply", file));
  }
}

TEST_F(PlyReader, AcceptsFacesBeforeVertices) {
  const Scan scan = read("a.ply", header("ascii",
                                         "element face 2\nproperty list uchar int vertex_indices\n"
                                         "element vertex 5\n" +
                                             kXyz) +
                                      "4 0 1 2 3\n3 0 3 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 1 0\n");
  EXPECT_EQ(scan.mesh.triangles.size(), 3u);
  EXPECT_EQ(scan.polygons_triangulated, 1);
  expect_parts(error("b.ply", header("ascii",
                                     "element face 1\nproperty list uchar int vertex_indices\n"
                                     "element vertex 3\n" +
                                         kXyz) +
                                  "3 0 1 3\n0 0 0\n1 0 0\n0 1 0\n"),
               {"line 10", "vertex 3", "only 3 vertices"});
}

TEST_F(PlyReader, ReadsTriangleStrips) {
  const std::string declarations =
      "element vertex 5\n" + kXyz + "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const Scan scan =
      read("a.ply", header("ascii", declarations) + points + "9 0 1 2 3 3 -1 2 3 4\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
  expect_parts(error("b.ply", header("ascii", declarations) + points + "3 0 1 7\n"),
               {"line 15", "vertex 7"});
}

const std::string kGridHeader = "obj_info num_cols 3\nobj_info num_rows 2\nelement vertex 5\n" +
                                kXyz +
                                "property float intensity\nelement range_grid 6\n"
                                "property list uchar int vertex_indices\n";

TEST_F(PlyReader, TriangulatesARangeGrid) {
  const std::string points = "0 0 0 9\n1 0 0 9\n2 0 0 9\n0 1 0 9\n2 1 0 9\n";
  const Scan ascii =
      read("a.ply", header("ascii", kGridHeader) + points + "1 0\n1 1\n1 2\n1 3\n0\n1 4\n");
  EXPECT_EQ(ascii.mesh.triangles, (Triangles{{3, 0, 1}, {1, 2, 4}}));
  EXPECT_EQ(ascii.depth_jump_triangles, 0);
  EXPECT_FALSE(ascii.eye);
  std::string file = header("binary_big_endian", kGridHeader);
  for (const float x : {0, 0, 0, 9, 1, 0, 0, 9, 2, 0, 0, 9, 0, 1, 0, 9, 2, 1, 0, 9})
    file += bytes_of(x, std::endian::big);
  for (const std::int32_t i : {0, 1, 2, 3, -1, 4})
    file += i < 0 ? std::string(1, '\0') : '\1' + bytes_of(i, std::endian::big);
  const Scan binary = read("b.ply", file);
  EXPECT_EQ(binary.mesh.triangles, ascii.mesh.triangles);
  EXPECT_EQ(binary.mesh.points, ascii.mesh.points);
}

/// A vertex that cannot be used is dropped, and its ray has met nothing.
TEST_F(PlyReader, TriangulatesARangeGridAroundBadVertices) {
  const Scan scan = read("a.ply", header("ascii", kGridHeader) +
                                      "0 0 0 9\n1 0 0 9\n2 0 0 9\n0 1 0 9\nnan 1 0 9\n"
                                      "1 0\n1 1\n1 2\n1 3\n0\n1 4\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{3, 0, 1}}));
  EXPECT_EQ(scan.bad_vertices, 1);
}

TEST_F(PlyReader, PassesOverTheGridOfAMesh) {
  const Scan scan =
      read("a.ply", header("ascii", kTriangle + "element range_grid 1\n"
                                                "property list uchar int vertex_indices\n") +
                        kTriangleBody + "1 0\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
}

TEST_F(PlyReader, RefusesBadRangeGrids) {
  const std::string points = "0 0 0 9\n1 0 0 9\n2 0 0 9\n0 1 0 9\n2 1 0 9\n";
  const auto grid = [&](const std::string& cells) {
    return error("a.ply", header("ascii", kGridHeader) + points + cells);
  };
  expect_parts(grid("1 0\n1 1\n1 5\n"),
               {"line 20", "refers to vertex 5", "only 5 vertices, numbered from 0"});
  expect_parts(grid("1 -1\n"), {"line 18", "refers to vertex -1"});
  expect_parts(grid("2 0 1\n"), {"line 18", "has 2 vertices, not 0 or 1"});
  expect_parts(grid("1 0\n0\n"), {"promises 6 records of element 'range_grid'", "ends after 2"});
  expect_parts(grid("1 0\n0\n0\n0\n0\n1 4\n"), {"5 points but no three of them are neighbours"});
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string declarations = kGridHeader;
    declarations.replace(declarations.find(from), from.size(), to);
    return error("b.ply", header("ascii", declarations) + points + "0\n0\n0\n0\n0\n0\n");
  };
  expect_parts(changed("num_cols 3", "num_cols 4"), {"line 10", "has 6 cells", "num_cols is 4"});
  expect_parts(changed("num_cols 3", "num_cols 0"), {"num_cols is 0"});
  expect_parts(changed("num_rows 2", "num_rows two"), {"obj_info num_rows", "missing"});
}

TEST_F(PlyReader, TriangulatesPolygonsAndCountsShortFaces) {
  const Scan scan = read("a.ply", header("ascii", "element vertex 4\n" + kXyz +
                                                      "element face 4\nproperty list uchar int "
                                                      "vertex_indices\n") +
                                      "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n2 0 1\n1 0\n0\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scan.polygons_triangulated, 1);
  EXPECT_EQ(scan.faces_skipped, 3);
}

TEST_F(PlyReader, AcceptsEveryKindOfLineEnd) {
  const std::string plain = header("ascii", kTriangle) + kTriangleBody;
  for (const std::string end : {"\r\n", "\r", " \n", "\t\r\n"}) {
    std::string file;
    for (const char c : plain) file += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(read("a.ply", file).mesh.triangles.size(), 1u);
    file.resize(file.size() - end.size());
    EXPECT_EQ(read("a.ply", file).mesh.triangles.size(), 1u);
  }
  EXPECT_EQ(read("a.ply", "\xef\xbb\xbf" + plain).mesh.points.size(), 3u);
}

/// Binary data that begins with a line feed, behind a header of each kind of line end.
TEST_F(PlyReader, FindsTheFirstByteOfBinaryData) {
  const std::string plain = header("binary_little_endian",
                                   "element vertex 3\nproperty uchar x\nproperty uchar y\n"
                                   "property uchar z\nelement face 1\n"
                                   "property list uchar uchar vertex_indices\n");
  const std::string body =
      "\n\r\n"
      "123"
      "456"
      "\3" +
      std::string("\0\1\2", 3);
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string file;
    for (const char c : plain) file += c == '\n' ? end : std::string(1, c);
    const Scan scan = read("a.ply", file + body);
    EXPECT_EQ(point(scan, 0), Eigen::Vector3d(10, 13, 10));
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  }
}

TEST_F(PlyReader, RefusesAPromiseThatTheFileDoesNotKeep) {
  const std::string many = "element vertex 1000000000000\n" + kXyz;
  expect_parts(error("a.ply", header("ascii", many) + "0 0 0\n1 0 0\n"),
               {"line 10", "the header promises 1000000000000 vertices", "ends after 2"});
  const std::string cut = header("binary_little_endian", many) + std::string(30, '\0');
  expect_parts(error("b.ply", cut), {"byte " + std::to_string(cut.size()),
                                     "promises 1000000000000 vertices", "ends after 2"});
  expect_parts(error("c.ply", header("ascii", kTriangle) + "0 0 0\n1 0 0\n0 1 0\n"),
               {"promises 1 faces", "ends after 0"});
  expect_parts(error("d.ply", header("binary_little_endian",
                                     "element junk 5\nproperty list uint double a\n" + kTriangle) +
                                  std::string(6, '\xff')),
               {"5 records of element 'junk'", "ends after 0"});
}

TEST_F(PlyReader, RefusesBadValuesWithTheirLine) {
  const auto ascii = [&](const std::string& body) {
    return error("a.ply", header("ascii", kTriangle) + body);
  };
  expect_parts(ascii("0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n"),
               {"line 12", "y coordinate", "not a finite"});
  expect_parts(ascii("0 0 0\n-inf 0 0\n0 1 0\n3 0 1 2\n"),
               {"line 11", "x coordinate", "not a finite"});
  expect_parts(ascii("0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n"),
               {"line 11", "z coordinate", "not a finite"});
  expect_parts(ascii("0 0 0\n1 0 1e40\n0 1 0\n3 0 1 2\n"), {"line 11", "implausibly large"});
  expect_parts(ascii("0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), {"line 11", "line ends where z should be"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n"), {"line 12", "expected y, found '1,5'"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
               {"line 13", "vertex 3", "only 3", "from 0"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), {"line 13", "vertex -1"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), {"line 13", "vertex_indices should be"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n3 0 1"), {"line 13", "the file ends where"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), {"line 13", "negative"});
  expect_parts(ascii("0 0 0\n1 0 0\n0 1 0\n70000 0 1 2\n"), {"line 13", "more than 65535 corners"});
}

/// A line holds one record. What it has behind the record is surplus.
TEST_F(PlyReader, CountsSurplusValues) {
  const Scan scan =
      read("a.ply", header("ascii", kTriangle) + "0 0 0 7\n1 0 0\n0 1 0 x 8 \n3 0 1 2 9\n");
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(scan.surplus_values, 4);
  EXPECT_EQ(read("b.ply", header("ascii", kTriangle) + kTriangleBody).surplus_values, 0);
  // Two records in one line look like surplus until the file ends.
  expect_parts(error("c.ply", header("ascii", kTriangle) + "0 0 0 1 0 0\n0 1 0\n3 0 1 2\n"),
               {"promises 1 faces", "ends after 0", "line 10 has more values"});
}

TEST_F(PlyReader, ReadsRecordsThatGoOnInTheNextLine) {
  const std::string declarations = "element vertex 3\n" + kXyz +
                                   "property uchar red\nproperty list uchar int extra\n" +
                                   "element face 1\nproperty list uchar int vertex_indices\n";
  const Scan scan = read("a.ply", header("ascii", declarations) +
                                      "0 0 0\n255\n0\n1\n0 0\n\n255 2\n7 8\n0 1 0\n255 0\n"
                                      "3 0\n1\n2");
  EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(scan.surplus_values, 0);
  expect_parts(error("b.ply", header("ascii", declarations) + "0 0 0\n255 0\n1 0\n0 255 0 1\n"),
               {"line 14", "the line ends where z should be"});
  expect_parts(error("c.ply", header("ascii", declarations) + "0 0 0\n255 2\n7\n\n"),
               {"line 14", "the file ends where extra should be"});
}

TEST_F(PlyReader, CountsHeaderLinesThatMeanNothing) {
  const Scan scan = read(
      "a.ply", header("ascii", "# made by x\nTextureFile a.png\n" + kTriangle) + kTriangleBody);
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(scan.unknown_header_lines, 2);
}

TEST_F(PlyReader, ReadsIntegersOf64Bits) {
  const std::string declarations =
      "element vertex 3\nproperty int64 x\nproperty uint64 y\nproperty float z\n"
      "element face 1\nproperty list uint64 int64 vertex_indices\n";
  const std::string text = "-5000000000 0 0\n0 18446744073709551615 0\n0 1 0\n3 0 1 2\n";
  const Scan ascii = read("a.ply", header("ascii", declarations) + text);
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto put = [&](auto value) { return bytes_of(value, order); };
    std::string file = header(
        order == std::endian::little ? "binary_little_endian" : "binary_big_endian", declarations);
    file += put(std::int64_t{-5000000000}) + put(std::uint64_t{0}) + put(0.f);
    file += put(std::int64_t{0}) + put(~std::uint64_t{0}) + put(0.f);
    file += put(std::int64_t{0}) + put(std::uint64_t{1}) + put(0.f);
    file += put(std::uint64_t{3});
    for (const std::int64_t i : {0, 1, 2}) file += put(i);
    const Scan scan = read("b.ply", file);
    EXPECT_EQ(scan.mesh.triangles, ascii.mesh.triangles);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(point(scan, i), point(ascii, i));
    EXPECT_EQ(point(scan, 0).x(), -5e9);
    EXPECT_EQ(point(scan, 1).y(), std::ldexp(1.0, 64));
  }
  // A list can promise more bytes than 64 bits can count.
  const std::string lists = "element vertex 1\nproperty list uint64 double a\n" + kXyz;
  expect_parts(error("c.ply", header("binary_little_endian", lists) +
                                  bytes_of((std::uint64_t{1} << 62) + 1) + std::string(40, '\0')),
               {"promises 1 vertices", "ends after 0"});
}

TEST_F(PlyReader, RefusesBadBinaryValuesWithTheirByte) {
  std::string file = header("binary_little_endian", kTriangle);
  const std::size_t start = file.size();
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, std::nanf(""), 0.f, 1.f, 0.f}) file += bytes_of(x);
  file += '\x03' + bytes_of(0) + bytes_of(1) + bytes_of(2);
  expect_parts(error("a.ply", file), {"byte " + std::to_string(start + 12), "z coordinate"});
  expect_parts(error("a.ply.gz", gzip(file)), {"byte " + std::to_string(start + 12) + " after"});
}

TEST_F(PlyReader, RefusesBadHeaders) {
  expect_parts(error("a.ply", "OFF\n"), {"the file is an OFF file"});
  expect_parts(error("a.ply", "OBJ\n"), {"line 1", "not a PLY file"});
  expect_parts(error("a.ply", std::string(100'000, 'p')), {"not a PLY file"});
  expect_parts(error("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"),
               {"ends within its header"});
  expect_parts(error("a.ply", "ply\nformat ascii 2.0\nend_header\n"), {"line 2", "version '2.0'"});
  expect_parts(error("a.ply", "ply\nformat zip 1.0\nend_header\n"), {"line 2", "encoding 'zip'"});
  expect_parts(error("a.ply", "ply\nelement vertex 3\n" + kXyz + "end_header\n0 0 0\n"),
               {"'format'"});
  expect_parts(error("a.ply", header("ascii", "element vertex -3\n" + kXyz)),
               {"line 3", "negative"});
  expect_parts(error("a.ply", header("ascii", "element vertex 99999999999999999999\n")),
               {"line 3", "expected the element's count"});
  expect_parts(error("a.ply", header("ascii", kXyz)), {"line 3", "before any element"});
  expect_parts(error("a.ply", header("ascii", "element vertex 3\nproperty float3 x\n")),
               {"line 4", "'float3'"});
  expect_parts(error("a.ply", header("ascii", "element vertex 3\nproperty list float int x\n")),
               {"line 4", "integer"});
  expect_parts(
      error("a.ply", header("ascii", "element vertex 3\nproperty float x\nproperty float y\n")),
      {"line 3", "no property z"});
  expect_parts(error("a.ply", header("ascii", "element face 3\n")), {"no element vertex"});
  expect_parts(error("a.ply", header("ascii", kTriangle + "element vertex 3\n" + kXyz)), {"twice"});
  expect_parts(error("a.ply", header("ascii", "element vertex 1\n" + kXyz +
                                                  "element face 1\nproperty uchar red\n") +
                                  "0 0 0\n1\n"),
               {"line 7", "no list vertex_indices"});
  std::string comments;
  for (int i = 0; i < 20'000; ++i) comments += "comment\n";
  expect_parts(error("a.ply", header("ascii", comments)), {"more than 10000 lines"});
}

TEST_F(PlyReader, RefusesScansWithoutASurface) {
  expect_parts(error("a.ply", header("ascii", "element vertex 2\n" + kXyz) + "0 0 0\n1 0 0\n"),
               {"2 points but no faces", "organised PCD", "range_grid", "Poisson"});
  expect_parts(error("b.ply", header("ascii", "element vertex 0\n" + kXyz +
                                                  "element face 0\n"
                                                  "property list uchar int vertex_indices\n") +
                                  "\n"),
               {"holds no vertices"});
  expect_parts(error("c.ply", header("ascii", kTriangle) + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
               {"none of its 1 faces has three corners"});
}

}  // namespace
}  // namespace semigeo::io
