#include "jobs/stages/surface_job.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/kinds/surface.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using kernels::TriangleMesh;

std::string bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class SurfaceJobTest : public testing::Test {
 protected:
  SurfaceJob job_for(const fs::path& input, const SurfaceParameters& parameters = {}) {
    SurfaceJob job;
    job.input = input;
    job.input_name = "folder/" + input.filename().string();
    job.name = "name of " + input.filename().string();
    job.output = folder_ / "scan.vtkhdf";
    job.input_xxh3 = io::xxh3_of_file(input);
    job.key = surface_key(job.name, job.input_xxh3, to_json(parameters));
    return job;
  }
  SurfaceJobResult run(const SurfaceJob& job, const SurfaceParameters& parameters = {},
                       int threads = 2) {
    engine::Workers workers(threads);
    engine::Observer observer;
    return run_surface_job(job, parameters, {workers, observer, {}});
  }
  fs::path scan(const TriangleMesh& mesh) { return tests::write_obj(folder_ / "scan.obj", mesh); }

  /// The error of a job that must fail, and leave nothing behind.
  io::Error refusal(const SurfaceJob& job, const SurfaceParameters& parameters = {}) {
    try {
      run(job, parameters);
    } catch (const io::Error& error) {
      for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().extension(), ".obj") << entry.path();
      return error;
    }
    ADD_FAILURE() << "the job succeeded";
    return {"", "", ""};
  }

  tests::TemporaryFolder folder_;
};

TEST_F(SurfaceJobTest, DatasetOfASphere) {
  const SurfaceParameters parameters = {.levels = 3, .length_unit = "mm"};
  const SurfaceJob job = job_for(scan(shapes::icosphere(3, 10)), parameters);
  const SurfaceJobResult result = run(job, parameters);
  EXPECT_EQ(result.format, "OBJ");
  EXPECT_EQ(result.vertices, 642);
  EXPECT_EQ(result.triangles, 1280);
  EXPECT_EQ(result.parts, 1);
  EXPECT_EQ(result.levels, 4);
  EXPECT_EQ(result.repairs, ScanRepairs{});

  const io::Dataset dataset(job.output);
  dataset.verify();
  const io::DatasetHeader& header = dataset.header();
  EXPECT_EQ(header.parameters, json_of(parameters));
  EXPECT_EQ(header.input_name, job.input_name);
  EXPECT_EQ(header.input_xxh3, job.input_xxh3);
  EXPECT_EQ(header.job_key, job.key);
  EXPECT_EQ(header.length_unit, "mm");
  EXPECT_EQ(header.origin, (std::array<double, 3>{0, 0, 0}));
  const nlohmann::json& repairs = header.repairs;
  EXPECT_EQ(repairs.size(), 14u);
  for (const auto& [name, count] : repairs.items()) EXPECT_EQ(count, 0) << name;

  ASSERT_EQ(dataset.level_count(), 4);
  double previous = 0;
  for (int k = 0; k < 4; ++k) {
    const io::LevelInfo level = dataset.level(k);
    EXPECT_EQ(level.iteration, k);
    EXPECT_EQ(level.vertices, 642);
    EXPECT_EQ(level.triangles, 1280);
    EXPECT_EQ(level.parts, 1);
    EXPECT_NEAR(level.mean_edge_length, 1.5, 0.1);
    EXPECT_EQ(level.step, dataset.level(0).mean_edge_length);
    EXPECT_NEAR(level.scale, level.step * std::sqrt(k + 1.0), 2e-3 * level.step);
    EXPECT_GT(level.scale, previous);
    previous = level.scale;
    for (const float h : dataset.read_floats(k, "mean_curvature")) EXPECT_NEAR(h, -0.1, 0.0005);
    for (const float c : dataset.read_floats(k, "gaussian_curvature")) EXPECT_NEAR(c, 0.01, 0.0001);
    for (const float c : dataset.read_floats(k, "patch_completeness")) EXPECT_EQ(c, 1);
  }
  EXPECT_TRUE(fs::exists(folder_ / "scan.xdmf"));
}

// Inside, vertices and faces are sorted for locality; nothing of that shows.
TEST_F(SurfaceJobTest, VerticesAndTrianglesKeepTheOrderOfTheFile) {
  TriangleMesh mesh = shapes::torus(1, 0.4, 60, 40, 0.3);
  std::ranges::reverse(mesh.triangles);
  const auto first = static_cast<std::int32_t>(mesh.points.size());
  for (const auto& p : shapes::icosphere(1).points) mesh.points.push_back(0.1 * p);
  for (const auto& [a, b, c] : shapes::icosphere(1).triangles)
    mesh.triangles.insert(mesh.triangles.begin(), {a + first, b + first, c + first});
  const SurfaceJob job = job_for(scan(mesh));
  EXPECT_EQ(run(job, {.levels = 2}).parts, 2);

  const io::Dataset dataset(job.output);
  const auto points = dataset.read_floats(0, "points");
  ASSERT_EQ(points.size(), 3 * mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(points[3 * v + c], static_cast<float>(mesh.points[v][static_cast<int>(c)]));
  for (int k = 0; k < 3; ++k) {
    const auto triangles = dataset.read_integers(k, "triangles");
    ASSERT_EQ(triangles.size(), 3 * mesh.triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      ASSERT_EQ(triangles[t], mesh.triangles[t / 3][t % 3]);
    auto source = dataset.read_integers(k, "source_vertex");
    std::vector<std::int64_t> expected(mesh.points.size());
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(source, expected);
    const auto part = dataset.read_integers(k, "part");
    for (std::size_t v = 0; v < part.size(); ++v)
      ASSERT_EQ(part[v], v < static_cast<std::size_t>(first) ? 0 : 1);
    // Fields too: each is near what the torus has at that vertex.
    const auto moved = dataset.read_floats(k, "points");
    const auto normals = dataset.read_floats(k, "normals");
    const auto gaussian = dataset.read_floats(k, "gaussian_curvature");
    const auto mean = dataset.read_floats(k, "mean_curvature");
    for (std::size_t v = 0; v < static_cast<std::size_t>(first); ++v) {
      const Eigen::Vector3d& p = mesh.points[v];
      const double ring = std::hypot(p.x(), p.y());
      const double cosine = (ring - 1) / 0.4;
      ASSERT_NEAR(moved[3 * v], p.x(), 0.1);
      ASSERT_NEAR(normals[3 * v + 2], p.z() / 0.4, 0.2);
      ASSERT_NEAR(gaussian[v], cosine / (0.4 * ring), 1);         // from -4.2 to 1.8
      ASSERT_NEAR(mean[v], -(1 / 0.4 + cosine / ring) / 2, 0.4);  // from -0.4 to -1.6
    }
  }
}

TEST_F(SurfaceJobTest, FarFromTheOriginDetailIsKept) {
  TriangleMesh mesh = shapes::icosphere(3);
  const Eigen::Vector3d far(4'500'000.25, -5'400'000.5, 812.125);
  for (auto& p : mesh.points) p += far;
  const SurfaceJob job = job_for(scan(mesh));
  run(job, {.levels = 1});
  const io::Dataset dataset(job.output);
  const auto& origin = dataset.header().origin;
  const auto points = dataset.read_floats(0, "points");
  for (std::size_t v = 0; v < mesh.points.size(); ++v)
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_NEAR(origin[c] + points[3 * v + c], mesh.points[v][static_cast<int>(c)], 1e-6);
  for (const float h : dataset.read_floats(1, "mean_curvature")) EXPECT_NEAR(h, -1, 0.03);
}

TEST_F(SurfaceJobTest, EveryNumberOfThreadsGivesTheSameBytes) {
  TriangleMesh mesh = shapes::torus(1, 0.4, 300, 100, 0.3);  // several chunks of each array
  shapes::add_noise(mesh, 0.001, 1);
  const fs::path input = scan(mesh);
  for (const io::Compression compression : {io::Compression::kDeflate, io::Compression::kNone}) {
    const SurfaceParameters parameters = {.levels = 1, .compression = compression};
    const SurfaceJob job = job_for(input, parameters);
    run(job, parameters, 1);
    const std::string one = bytes_of(job.output);
    for (const int threads : {2, 4}) {
      fs::remove(job.output);
      run(job, parameters, threads);
      EXPECT_TRUE(one == bytes_of(job.output)) << threads << " threads";
    }
  }
}

TEST_F(SurfaceJobTest, CompressionChangesTheFileButNoValue) {
  const fs::path input = scan(shapes::torus(1, 0.4, 60, 40, 0.3));
  run(job_for(input), {.levels = 1});
  fs::rename(folder_ / "scan.vtkhdf", folder_ / "packed.vtkhdf");
  run(job_for(input), {.levels = 1, .compression = io::Compression::kNone});
  EXPECT_GT(fs::file_size(folder_ / "scan.vtkhdf"), fs::file_size(folder_ / "packed.vtkhdf"));
  const io::Dataset plain(folder_ / "scan.vtkhdf"), packed(folder_ / "packed.vtkhdf");
  for (const char* name : {"points", "normals", "gaussian_curvature", "mean_curvature"})
    EXPECT_EQ(plain.read_floats(1, name), packed.read_floats(1, name)) << name;
}

TEST_F(SurfaceJobTest, PrincipalCurvaturesOnRequest) {
  const fs::path input = scan(shapes::torus(1, 0.4, 60, 40, 0.3));
  run(job_for(input), {.levels = 1});
  EXPECT_FALSE(io::Dataset(folder_ / "scan.vtkhdf").has_principal());
  EXPECT_THROW(io::Dataset(folder_ / "scan.vtkhdf").read_floats(0, "principal_curvature_1"),
               io::Error);
  run(job_for(input), {.levels = 1, .evolution = {.principal = true}});
  const io::Dataset dataset(folder_ / "scan.vtkhdf");
  dataset.verify();
  ASSERT_TRUE(dataset.has_principal());
  for (int k = 0; k < 2; ++k) {
    const auto gaussian = dataset.read_floats(k, "gaussian_curvature");
    const auto mean = dataset.read_floats(k, "mean_curvature");
    const auto k1 = dataset.read_floats(k, "principal_curvature_1");
    const auto k2 = dataset.read_floats(k, "principal_curvature_2");
    const auto first = dataset.read_floats(k, "principal_direction_1");
    const auto second = dataset.read_floats(k, "principal_direction_2");
    const auto normals = dataset.read_floats(k, "normals");
    for (std::size_t v = 0; v < k1.size(); ++v) {
      EXPECT_GE(k1[v], k2[v]);
      EXPECT_NEAR(k1[v] * k2[v], gaussian[v], 2e-4);
      EXPECT_NEAR((k1[v] + k2[v]) / 2, mean[v], 2e-5);
      const Eigen::Map<const Eigen::Vector3f> a(&first[3 * v]), b(&second[3 * v]),
          n(&normals[3 * v]);
      EXPECT_NEAR(a.norm(), 1, 1e-5);
      EXPECT_NEAR(a.cross(b).dot(n), 1, 0.02);
    }
  }
  std::ifstream sidecar(folder_ / "scan.xdmf");
  const std::string text((std::istreambuf_iterator<char>(sidecar)), {});
  EXPECT_NE(text.find("principal_direction_2"), std::string::npos);
  EXPECT_EQ(text, io::sidecar_text(folder_ / "scan.vtkhdf"));
}

TEST_F(SurfaceJobTest, LevelZeroAlone) {
  const SurfaceJob job = job_for(scan(shapes::icosphere(1)));
  EXPECT_EQ(run(job, {.levels = 0}).levels, 1);
  EXPECT_EQ(io::Dataset(job.output).level_count(), 1);
}

TEST_F(SurfaceJobTest, RepairsAreCountedInTheDataset) {
  std::ofstream(folder_ / "scan.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 9\nv 1 0 0\n"
                                         "v 0 5 5\nv 1 1 0\n"
                                         "f 1 3 2\nf 1 2 4\nf 6 3 4\nf 1 4 3\n"  // 6 is 2 again
                                         "f 3 1 4\nf 1 1 2\nf 1 2 7\nf 2 8\n";
  const SurfaceJob job = job_for(folder_ / "scan.obj");
  const SurfaceJobResult result = run(job, {.levels = 1});
  EXPECT_EQ(result.vertices, 7);  // the fin has copies of its two vertices
  EXPECT_EQ(result.triangles, 5);
  EXPECT_EQ(io::Dataset(job.output).header().repairs,
            (nlohmann::json{{"welded_vertices", 1},
                            {"degenerate_faces", 1},
                            {"duplicate_faces", 1},
                            {"flipped_faces", 0},
                            {"nonmanifold_edges", 1},
                            {"split_vertices", 2},
                            {"gap_vertices", 0},
                            {"turned_parts", 0},
                            {"isolated_vertices", 2},
                            {"polygons_triangulated", 0},
                            {"bytes_after_end", 0},
                            {"faces_skipped", 1},
                            {"bad_vertices", 0},
                            {"faces_of_bad_vertices", 0}}));
  EXPECT_EQ(json_of(result.repairs).at("isolated_vertices"), 2);
}

/// What few scans have is named only in their datasets.
TEST_F(SurfaceJobTest, WhatTheReaderToleratesIsCountedInTheDataset) {
  std::ofstream(folder_ / "scan.ply")
      << "ply\nformat ascii 1.0\n# by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
  const SurfaceJob job = job_for(folder_ / "scan.ply");
  const SurfaceJobResult result = run(job, {.levels = 1});
  EXPECT_EQ(result.repairs.surplus_values, 3);
  const nlohmann::json repairs = io::Dataset(job.output).header().repairs;
  EXPECT_EQ(repairs.at("surplus_values"), 3);
  EXPECT_EQ(repairs.at("unknown_header_lines"), 1);
}

TEST_F(SurfaceJobTest, CoarseCoordinatesAreMeasured) {
  const ScanQuality fine = run(job_for(scan(shapes::icosphere(3))), {.levels = 0}).quality;
  EXPECT_NEAR(fine.mean_edge_length, 0.15, 0.02);
  EXPECT_LT(fine.coordinate_step, 1e-6);
  EXPECT_EQ(fine.without_patch, 0);
  // A sphere in a national grid, in single precision: its steps are half a unit. The numbers lie in
  // memory between, because GCC 12 leaves out the rounding of a pair of conversions.
  kernels::TriangleMesh far = shapes::icosphere(3, 40);
  std::vector<Eigen::Vector3f> single;
  for (const auto& p : far.points)
    single.emplace_back((p + Eigen::Vector3d(5e5, 5.4e6, 300)).cast<float>());
  for (std::size_t v = 0; v < single.size(); ++v) far.points[v] = single[v].cast<double>();
  EXPECT_EQ(run(job_for(scan(far)), {.levels = 0}).quality.coordinate_step, 0.5);
  // The same in double precision.
  far = shapes::icosphere(3, 40);
  for (auto& p : far.points) p += Eigen::Vector3d(5e5, 5.4e6, 300);
  EXPECT_LT(run(job_for(scan(far)), {.levels = 0}).quality.coordinate_step, 1e-4);
}

// Triangles that share nothing are parts of three vertices, on which no patch fits.
TEST_F(SurfaceJobTest, VerticesWithoutCurvatureAreCounted) {
  kernels::TriangleMesh loose;
  const kernels::TriangleMesh sphere = shapes::icosphere(3);
  for (const auto& t : sphere.triangles) {
    const auto n = static_cast<std::int32_t>(loose.points.size());
    const Eigen::Vector3d away = 0.02 * sphere.points[t[0]];
    for (const std::int32_t v : t) loose.points.emplace_back(sphere.points[v] + away);
    loose.triangles.push_back({n, n + 1, n + 2});
  }
  const ScanQuality quality = run(job_for(scan(loose)), {.levels = 0}).quality;
  EXPECT_GT(quality.without_patch, 2000);
  EXPECT_EQ(quality.on_small_parts, quality.without_patch);
}

TEST_F(SurfaceJobTest, GapsAreClosedAsTheParametersSay) {
  // Corners that differ by up to 0.004.
  kernels::TriangleMesh soup;
  const kernels::TriangleMesh sphere = shapes::icosphere(3);
  for (const auto& t : sphere.triangles) {
    const auto n = static_cast<std::int32_t>(soup.points.size());
    for (const std::int32_t v : t)
      soup.points.emplace_back(sphere.points[v] * (1 + 0.001 * (n / 3 % 3)));
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  const fs::path input = scan(soup);
  EXPECT_GT(run(job_for(input), {.levels = 0}).parts, 100);
  EXPECT_GT(run(job_for(input), {.levels = 0, .weld = "exact"}).parts, 100);
  const SurfaceJobResult welded = run(job_for(input), {.levels = 0, .weld = "0.01"});
  EXPECT_EQ(welded.parts, 1);
  EXPECT_EQ(welded.vertices, 642);
  EXPECT_EQ(welded.quality.weld_distance, 0.01);
}

TEST_F(SurfaceJobTest, AScanWithoutUsableTrianglesIsRefused) {
  std::ofstream(folder_ / "flat.obj") << "v 0 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 1\nf 1 2 3\n";
  const io::Error error = refusal(job_for(folder_ / "flat.obj"));
  EXPECT_EQ(error.file(), folder_ / "flat.obj");
  EXPECT_NE(error.problem().find("2 degenerate faces"), std::string::npos) << error.problem();
}

TEST_F(SurfaceJobTest, SizesBeyondSinglePrecisionAreRefused) {
  for (const double size : {1e-14, 1e14}) {
    const io::Error error = refusal(job_for(scan(shapes::icosphere(1, size))));
    EXPECT_EQ(error.file(), folder_ / "scan.obj");
    EXPECT_NE(error.problem().find("mean edge length"), std::string::npos) << error.problem();
  }
  for (const double size : {1e-10, 1e10}) {
    const SurfaceJob job = job_for(scan(shapes::icosphere(2, size)));
    run(job, {.levels = 1});
    for (const float h : io::Dataset(job.output).read_floats(1, "mean_curvature"))
      EXPECT_NEAR(h * size, -1, 0.1);
  }
}

TEST_F(SurfaceJobTest, AScanThatChangedSinceItWasPlannedIsRefused) {
  const SurfaceJob job = job_for(scan(shapes::icosphere(1)));
  std::ofstream(job.input, std::ios::app) << "# one line more\n";
  const io::Error error = refusal(job);
  EXPECT_EQ(error.file(), job.input);
  EXPECT_NE(error.problem().find("changed"), std::string::npos) << error.problem();
}

TEST_F(SurfaceJobTest, AMissingOrBrokenScanIsRefused) {
  SurfaceJob job = job_for(scan(shapes::icosphere(1)));
  std::ofstream(folder_ / "broken.obj") << "v 0 0 zero\n";
  job.input = folder_ / "broken.obj";
  EXPECT_EQ(refusal(job).file(), job.input);
  job.input = folder_ / "gone.obj";
  EXPECT_EQ(refusal(job).file(), job.input);
}

TEST_F(SurfaceJobTest, AFullDiskIsNamedAndNothingIsLeft) {
  const SurfaceJob job = job_for(scan(shapes::icosphere(4)));
  for (const rlim_t room : {10'000, 100'000, 300'000}) {
    const tests::FileSizeLimit limit(room);
    EXPECT_EQ(refusal(job).file(), job.output) << room;
  }
  EXPECT_NO_THROW(run(job));
}

TEST_F(SurfaceJobTest, AFailedRunLeavesTheOldDataset) {
  const SurfaceJob job = job_for(scan(shapes::icosphere(2)));
  run(job, {.levels = 1});
  const std::string before = bytes_of(job.output);
  SurfaceJob changed = job;
  changed.input_xxh3 = "another";
  EXPECT_THROW(run(changed, {.levels = 2}), io::Error);
  EXPECT_TRUE(before == bytes_of(job.output));
}

TEST_F(SurfaceJobTest, AMissingOutputFolderIsAnError) {
  SurfaceJob job = job_for(scan(shapes::icosphere(1)));
  job.output = folder_ / "no/such/scan.vtkhdf";
  EXPECT_EQ(refusal(job).file(), job.output);
}

}  // namespace
}  // namespace semigeo::jobs
