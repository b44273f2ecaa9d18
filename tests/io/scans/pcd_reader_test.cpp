#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using PcdReader = ScanFileTest;

/// A header for points of y (double), rgb, x, z and three values more.
std::string header(const std::string& data, int width = 3, int height = 2,
                   const std::string& viewpoint = "0 0 10 1 0 0 0") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS y rgb x z extra\n"
         "SIZE 8 4 4 4 1\nTYPE F U F F U\nCOUNT 1 1 1 1 3\nWIDTH " +
         std::to_string(width) + "\nHEIGHT " + std::to_string(height) + "\nVIEWPOINT " + viewpoint +
         "\nPOINTS " + std::to_string(width * height) + "\nDATA " + data + "\n";
}

const std::string kAscii =
    "0 7 0 0 1 2 3\n0 7 1 0 1 2 3\n0 7 2 0 1 2 3\n1 7 0 0 1 2 3\n1 7 1 0 1 2 3\n"
    "nan 7 nan nan 1 2 3\n";

/// The same six points, of which the last was not measured.
std::vector<std::string> columns() {
  std::vector<std::string> fields(5);
  for (int i = 0; i < 6; ++i) {
    const bool met = i < 5;
    fields[0] += bytes_of(met ? i / 3 + 0.0 : std::nan(""));
    fields[1] += bytes_of(7u);
    fields[2] += bytes_of(met ? static_cast<float>(i % 3) : std::nanf(""));
    fields[3] += bytes_of(met ? 0.f : std::nanf(""));
    fields[4] += "abc";
  }
  return fields;
}

std::string binary() {
  std::string body;
  const std::vector<std::string> fields = columns();
  for (int i = 0; i < 6; ++i)
    for (const std::string& field : fields)
      body += field.substr(i * field.size() / 6, field.size() / 6);
  return body;
}

/// LZF without references.
std::string compressed(std::string_view plain) {
  std::string packed;
  for (std::size_t at = 0; at < plain.size(); at += 32) {
    const std::string_view part = plain.substr(at, 32);
    packed += static_cast<char>(part.size() - 1);
    packed += part;
  }
  return bytes_of(static_cast<std::uint32_t>(packed.size())) +
         bytes_of(static_cast<std::uint32_t>(plain.size())) + packed;
}

std::string joined_columns() {
  std::string plain;
  for (const std::string& field : columns()) plain += field;
  return plain;
}

void expect_grid(const Scan& scan) {
  ASSERT_EQ(scan.mesh.points.size(), 5u);
  EXPECT_EQ(point(scan, 4), Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 1, 4}, {0, 4, 3}, {4, 1, 2}}));  // towards +z
  EXPECT_EQ(scan.eye, Eigen::Vector3d(0, 0, 10));
}

TEST_F(PcdReader, ReadsAllEncodings) {
  const Scan ascii = read("a.pcd", header("ascii") + kAscii);
  EXPECT_EQ(ascii.format, "PCD ascii");
  expect_grid(ascii);
  const Scan binary_scan = read("b.pcd", header("binary") + binary());
  EXPECT_EQ(binary_scan.format, "PCD binary");
  expect_grid(binary_scan);
  const Scan packed = read("c.pcd", header("binary_compressed") + compressed(joined_columns()));
  EXPECT_EQ(packed.format, "PCD binary compressed");
  expect_grid(packed);
  EXPECT_EQ(packed.bytes_after_end, 0);
  expect_grid(read("d.pcd.gz", gzip(header("binary") + binary())));
}

TEST_F(PcdReader, FacesTheViewpoint) {
  const Scan scan = read("a.pcd", header("ascii", 3, 2, "0 0 -10 1 0 0 0") + kAscii);
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{0, 4, 1}, {0, 3, 4}, {4, 2, 1}}));  // towards -z
}

TEST_F(PcdReader, RefusesPointClouds) {
  const std::string cloud = header("ascii", 6, 1) + kAscii;
  expect_parts(error("a.pcd", cloud),
               {"point cloud without order", "organised PCD", "PTX", "range_grid", "Poisson"});
}

TEST_F(PcdReader, RefusesBadHeaders) {
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = header("binary") + binary();
    text.replace(text.find(from), from.size(), to);
    return error("a.pcd", text);
  };
  expect_parts(with("FIELDS y", "FIELDS w"), {"no field y"});
  expect_parts(with("SIZE 8", "SIZE 2"), {"field y is not one floating-point number"});
  expect_parts(with("SIZE 8 4 4 4 1", "SIZE 8 4 4 4"), {"fewer values than FIELDS"});
  expect_parts(with("SIZE 8 4 4 4 1", "SIZE 8 4 4 4 1 1"), {"line 4", "more values than FIELDS"});
  expect_parts(with("TYPE F", "TYPE I"), {"field y is not one floating-point number"});
  expect_parts(with("COUNT 1", "COUNT -1"), {"line 6", "not in 0"});
  expect_parts(with("WIDTH 3", "WIDTH 4"), {"POINTS is 6, but WIDTH times HEIGHT is 8"});
  expect_parts(with("HEIGHT 2\n", ""), {"no HEIGHT"});
  expect_parts(with("HEIGHT 2", "HEIGHT 0"), {"holds no points"});
  expect_parts(with("DATA binary", "DATA text"), {"encoding 'text'"});
  expect_parts(error("b.pcd", "v 0 0 0\nv 1 0 0\n"), {"not a PCD file"});
  expect_parts(error("c.pcd", "VERSION 0.7\nFIELDS x y z\n"), {"ends within its header"});
  expect_parts(error("d.pcd", "VERSION 0.7\nFIELDS x y z\nWIDTH 2\nHEIGHT 2\nDATA binary\n"),
               {"no SIZE or no TYPE"});
}

TEST_F(PcdReader, RefusesCutData) {
  const std::string end = "the header promises 6 points, but the file ends after 5";
  expect_parts(error("a.pcd", header("ascii") + kAscii.substr(0, kAscii.find("nan"))), {end});
  const std::string body = binary();
  expect_parts(error("b.pcd", header("binary") + body.substr(0, body.size() - 1)), {end});
  const std::string packed = compressed(joined_columns());
  expect_parts(error("c.pcd", header("binary_compressed") + packed.substr(0, packed.size() - 1)),
               {"ends within its compressed data"});
  expect_parts(error("d.pcd", header("binary_compressed") + compressed("abc")),
               {"holds 3 bytes, not 6 points of 23 bytes"});
  std::string damaged = packed;
  damaged[8] = '\xff';
  expect_parts(error("e.pcd", header("binary_compressed") + damaged),
               {"compressed data is damaged"});
  expect_parts(error("f.pcd", header("ascii") + "0 7\n"), {"line ends where x should be"});
}

TEST_F(PcdReader, RefusesAGridWithoutTriangles) {
  expect_parts(error("a.pcd", header("ascii", 1, 6) + kAscii), {"5 points but no three"});
}

}  // namespace
}  // namespace semigeo::io
