#include "io/scans/mesh_writer.hpp"

#include <iterator>

#include "io/scans/glb_writer.hpp"
#include "io/scans/obj_writer.hpp"
#include "io/scans/stl_writer.hpp"
#include "io/scans/vtp_writer.hpp"
#include "tests/io/scans/scan_files.hpp"
#include "tests/support/file_size_limit.hpp"

namespace semigeo::io {
namespace {

class MeshWriter : public ::testing::Test {
 protected:
  std::string content(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "mesh.ply";
  std::vector<float> points_ = {0, 0, 0, 1.5f, 0, 0, 0, 1, -0.25f};
  std::vector<float> normals_ = {0, 0, 1, 0, 1, 0, 1, 0, 0};
  std::vector<std::int64_t> triangles_ = {2, 0, 1};
};

TEST_F(MeshWriter, WritesWhatTheReaderReads) {
  write_ply(path_, {.points = points_, .normals = {}, .triangles = triangles_, .scalars = {}});
  const Scan scan = read_scan(path_);
  EXPECT_EQ(scan.format, "PLY binary little endian");
  EXPECT_EQ(point(scan, 2), Eigen::Vector3d(0, 1, -0.25));
  EXPECT_EQ(scan.mesh.triangles, (Triangles{{2, 0, 1}}));
}

TEST_F(MeshWriter, OtherFormatsAreReadBack) {
  const std::vector<float> curvature = {1, 2, 3};
  const std::vector<std::int64_t> part = {7, 8, 9};
  const std::vector<std::uint8_t> colours = {0, 128, 255, 1, 2, 3, 4, 5, 6};
  const MeshView mesh = {.points = points_,
                         .normals = normals_,
                         .triangles = triangles_,
                         .scalars = {{"mean_curvature", curvature}},
                         .origin = {1000, 0, 0},
                         .colours = colours,
                         .integers = {{"part", part}}};
  write_ply(path_, mesh);
  write_obj(folder_ / "mesh.obj", mesh, "comment");
  write_vtp(folder_ / "mesh.vtp", mesh);
  write_glb(folder_ / "mesh.glb", mesh, "m");
  for (const char* name : {"mesh.ply", "mesh.obj", "mesh.vtp", "mesh.glb"}) {
    const Scan scan = read_scan(folder_ / name);
    EXPECT_EQ(point(scan, 1), Eigen::Vector3d(1001.5, 0, 0)) << name;
    EXPECT_EQ(scan.mesh.triangles, (Triangles{{2, 0, 1}})) << name;
  }
  write_stl(folder_ / "mesh.stl", mesh);
  EXPECT_EQ(read_scan(folder_ / "mesh.stl").mesh.points.size(), 3);
}

TEST_F(MeshWriter, OtherFormatsRefuseWhatIsNoMesh) {
  const std::vector<std::int64_t> outside = {0, 1, 3};
  const MeshView mesh = {.points = points_, .normals = {}, .triangles = outside, .scalars = {}};
  EXPECT_THROW(write_obj(path_, mesh, ""), Error);
  EXPECT_THROW(write_stl(path_, mesh), Error);
  EXPECT_THROW(write_vtp(path_, mesh), Error);
  EXPECT_THROW(write_glb(path_, mesh, ""), Error);
  EXPECT_FALSE(std::filesystem::exists(path_));
}

TEST_F(MeshWriter, WritesNormalsAndNamedScalarsByteByByte) {
  const std::vector<float> curvature = {1, 2, 3};
  write_ply(path_, {.points = points_,
                    .normals = normals_,
                    .triangles = triangles_,
                    .scalars = {{"mean_curvature", curvature}, {"quality", curvature}}});
  std::string expected =
      "ply\nformat binary_little_endian 1.0\ncomment written by semigeo\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "property float mean_curvature\nproperty float quality\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (int v = 0; v < 3; ++v) {
    for (int k = 0; k < 3; ++k) expected += bytes_of(points_[3 * v + k]);
    for (int k = 0; k < 3; ++k) expected += bytes_of(normals_[3 * v + k]);
    expected += bytes_of(curvature[v]) + bytes_of(curvature[v]);
  }
  expected += '\3' + bytes_of(2) + bytes_of(0) + bytes_of(1);
  EXPECT_EQ(content(path_), expected);
}

TEST_F(MeshWriter, KeepsThePrecisionOfFarOrigins) {
  write_ply(path_, {.points = points_,
                    .normals = normals_,
                    .triangles = triangles_,
                    .scalars = {},
                    .origin = {4.5e6, 0, 0.125}});
  EXPECT_EQ(point(read_scan(path_), 1), Eigen::Vector3d(4.5e6 + 1.5, 0, 0.125));
}

TEST_F(MeshWriter, RefusesWrongShapes) {
  const std::vector<float> two = {1, 2};
  const std::vector<float> three = {1, 2, 3};
  const auto write = [&](const MeshView& mesh) { write_ply(path_, mesh); };
  MeshView mesh{.points = points_, .normals = two, .triangles = triangles_, .scalars = {}};
  EXPECT_THROW(write(mesh), std::invalid_argument);
  mesh.normals = {};
  mesh.scalars = {{"a", two}};
  EXPECT_THROW(write(mesh), std::invalid_argument);
  mesh.scalars = {{"a b", three}};
  EXPECT_THROW(write(mesh), std::invalid_argument);
  mesh.scalars = {{"a", three}};
  EXPECT_NO_THROW(write(mesh));
}

TEST_F(MeshWriter, AFailureLeavesWhatWasThere) {
  write_file(path_, "before");
  const std::vector<std::int64_t> wrong = {0, 1, 3};
  const MeshView mesh{.points = points_, .normals = {}, .triangles = wrong, .scalars = {}};
  EXPECT_THROW(write_ply(path_, mesh), Error);
  EXPECT_EQ(content(path_), "before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
  EXPECT_THROW(write_ply(folder_ / "no folder" / "mesh.ply", mesh), Error);
}

TEST_F(MeshWriter, ReportsAFullDisk) {
  points_.assign(30'000, 1);
  std::string problem;
  try {
    const tests::FileSizeLimit limit(4096);
    write_ply(path_, {.points = points_, .normals = {}, .triangles = triangles_, .scalars = {}});
  } catch (const Error& failure) {
    problem = failure.problem();
  }
  expect_parts(problem, {"cannot be written"});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace semigeo::io
