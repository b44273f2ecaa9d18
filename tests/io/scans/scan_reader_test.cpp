#include "io/scans/scan_reader.hpp"

#include <unistd.h>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

using ScanReader = ScanFileTest;

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n";

TEST(ScanFormatTest, IsDecidedByTheName) {
  for (const char* name : {"a.ply", "x/y.b/a b.OBJ", "a.Off.gz", "a.ply.stl.GZ", "a.pcd", "a.PTX",
                           "a.gltf", "a.GLB.gz"})
    EXPECT_TRUE(is_scan_name(name)) << name;
  for (const char* name :
       {"a", "a.gz", "ply", ".ply", "a.plyx", "a.ply.zip", "a.ply.gz.gz", "", "a.ply/b"})
    EXPECT_FALSE(is_scan_name(name)) << name;
}

TEST(ScanFormatTest, ExtensionsAreListedInWords) {
  EXPECT_EQ(scan_extensions(", ", " and "),
            ".ply, .obj, .off, .stl, .pcd, .ptx, .gltf, .glb, .vtk and .vtp");
  EXPECT_EQ(scan_extensions(" ", " "), ".ply .obj .off .stl .pcd .ptx .gltf .glb .vtk .vtp");
}

TEST_F(ScanReader, ReadsCompressedFiles) {
  const Scan scan = read("a.obj.gz", gzip(kObj));
  EXPECT_EQ(scan.format, "OBJ, gzip");
  EXPECT_EQ(scan.mesh.triangles.size(), 3u);
  EXPECT_EQ(read("b.obj.gz", kObj).format, "OBJ");  // unpacked, but not renamed
}

TEST_F(ScanReader, FindsDamageOfGzipFirst) {
  std::string damaged = gzip(kObj);
  damaged[damaged.size() - 6] = static_cast<char>(damaged[damaged.size() - 6] ^ 1);  // the checksum
  expect_parts(error("a.obj.gz", damaged), {"gzip data is damaged"});
  expect_parts(error("b.ply.gz", damaged), {"gzip data is damaged"});  // not "not a PLY file"
  expect_parts(error("c.obj.gz", gzip(kObj).substr(0, 40)), {"in the middle of its gzip data"});
}

/// What stands behind the last face is read although nobody asks for it.
TEST_F(ScanReader, FindsDamageOfGzipBehindTheEnd) {
  std::string tail;
  for (unsigned i = 0; i < 3'000'000; ++i) tail += static_cast<char>((i * 2'654'435'761u) >> 24);
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  std::string packed = gzip(off + tail);
  EXPECT_GT(read("a.off.gz", packed).bytes_after_end, 2'500'000);
  packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] ^ 1);
  expect_parts(error("b.off.gz", packed), {"gzip data is damaged"});
  expect_parts(error("c.ply.gz", packed), {"gzip data is damaged"});
}

TEST_F(ScanReader, CountsWhatStandsBehindTheEnd) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read("a.off", off).bytes_after_end, 0);
  EXPECT_EQ(read("a.off", off + " \n# the end\n\n").bytes_after_end, 0);
  EXPECT_EQ(read("a.off", off + "3 0 1 2\n").bytes_after_end, 4);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read("a.ply", ply + "\r\n").bytes_after_end, 0);
  EXPECT_EQ(read("a.ply", ply + "3 2 1 0\n").bytes_after_end, 4);
  EXPECT_EQ(read("a.obj", kObj).bytes_after_end, 0);
}

TEST_F(ScanReader, NamesWhatIsWrongWithTheFile) {
  expect_parts(error("a.obj", ""), {"the file is empty"});
  expect_parts(error("a.obj.gz", gzip("")), {"the file is empty"});
  expect_parts(error("a.xyz", "1 2 3"), {"not that of a scan", ".ply"});
  EXPECT_THROW(read_scan(folder_ / "missing.ply"), Error);
  std::filesystem::create_directory(folder_ / "folder.ply");
  EXPECT_THROW(read_scan(folder_ / "folder.ply"), Error);
}

TEST_F(ScanReader, NamesMissingPermission) {
  const std::filesystem::path file = write_file(folder_ / "a.obj", kObj);
  std::filesystem::permissions(file, std::filesystem::perms::none);
  // Root may read everything, so as root the test is somebody else for a moment.
  constexpr uid_t kNobody = 65534;
  const bool root = ::geteuid() == 0;
  if (root) ASSERT_EQ(::seteuid(kNobody), 0);
  std::string problem = "was read";
  try {
    read_scan(file);
  } catch (const Error& failure) {
    problem = failure.problem();
  }
  if (root) ASSERT_EQ(::seteuid(0), 0);
  EXPECT_EQ(problem, "reading is not permitted");
}

TEST_F(ScanReader, EnforcesItsLimits) {
  EXPECT_EQ(read("a.obj", kObj, {.max_vertices = 4, .max_triangles = 3}).mesh.triangles.size(), 3u);
  expect_parts(error("a.obj", kObj, {.max_vertices = 3}), {"line 4", "more than 3 vertices"});
  expect_parts(error("a.obj", kObj, {.max_triangles = 2}), {"line 6", "more than 2 triangles"});
  expect_parts(error("a.obj", kObj, {.max_coordinate = 0.5}), {"line 2", "implausibly large"});
  const std::string off = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  expect_parts(error("a.off", off, {.max_vertices = 3}), {"line 2", "more than 3 vertices"});
  expect_parts(error("a.off.gz", gzip("OFF\n1000000000000 1 0\n")),
               {"more than 200000000 vertices"});
}

/// Memory must follow what the file holds, never what its header promises.
TEST_F(ScanReader, ReservesNothingForEmptyPromises) {
  const std::string declarations =
      "element vertex 2000000000\nproperty float x\nproperty float y\nproperty float z\n";
  for (const std::string encoding : {"ascii", "binary_little_endian"})
    expect_parts(
        error("a.ply", "ply\nformat " + encoding + " 1.0\n" + declarations + "end_header\n"),
        {"promises 2000000000 vertices", "ends after 0"});
}

}  // namespace
}  // namespace semigeo::io
