// Encoding, writing, verifying and reading a dataset of 163,842 vertices and three levels, on one
// thread. The values are those of a rough surface: their mantissas are noise, as a scan's are.
#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "bench/support/memory.hpp"
#include "io/dataset/dataset_writer.hpp"
#include "io/files/chunk_codec.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::bench {
namespace {

namespace fs = std::filesystem;
using io::Compression;

constexpr int kLevels = 3;

/// Stand-in for what a surface job computes.
struct Content {
  Content() {
    kernels::TriangleMesh mesh = shapes::icosphere(7, 10);
    triangles = mesh.triangles;
    for (const auto& p : mesh.points) normals.push_back((p / 10).cast<float>());
    shapes::add_noise(mesh, 0.01, 1);
    for (const auto& p : mesh.points) {
      points.push_back(p.cast<float>());
      mean.push_back(static_cast<float>(-1 / p.norm()));
      gaussian.push_back(mean.back() * mean.back());
    }
    completeness.assign(points.size(), 1.0f);
    part.assign(points.size(), 0);
    source.resize(points.size());
    std::iota(source.begin(), source.end(), 0);
    for (kernels::SampledContours& none : features.contours) none.offsets = {0};
  }

  io::EncodedConnectivity encode_connectivity(Compression compression) const {
    return {io::encode_array(io::array_of(std::span(triangles)), compression),
            io::encode_array(io::array_of(std::span(source), io::ElementType::kInt64), compression),
            io::encode_array(io::array_of(std::span(part)), compression)};
  }
  io::EncodedFields encode_fields(Compression compression) const {
    return {io::encode_array(io::array_of(std::span(points)), compression),
            io::encode_array(io::array_of(std::span(normals)), compression),
            io::encode_array(io::array_of(std::span(gaussian)), compression),
            io::encode_array(io::array_of(std::span(mean)), compression),
            io::encode_array(io::array_of(std::span(completeness)), compression),
            io::encode_features(io::tables_of(features), compression)};
  }
  std::int64_t vertices() const { return static_cast<std::int64_t>(points.size()); }
  /// Bytes of a level's fields before compression.
  std::int64_t field_bytes() const { return vertices() * 9 * 4; }

  std::vector<Eigen::Vector3f> points, normals;
  std::vector<float> gaussian, mean, completeness;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source, part;
  kernels::LevelFeatures features;  // none: they are few beside the vertices
};

void write(const fs::path& path, const Content& content, Compression compression) {
  io::DatasetWriter writer(path, {}, compression);
  writer.write_connectivity(content.encode_connectivity(compression));
  for (int k = 0; k < kLevels; ++k)
    writer.write_level(
        {.iteration = k, .step = 1, .scale = std::sqrt(k + 1.0), .mean_edge_length = 1, .parts = 1},
        content.encode_fields(compression));
  writer.write_selection({.feature_counts = std::vector<std::int64_t>(kLevels),
                          .smoothed = std::vector<double>(kLevels)});
  writer.finish();
}

void encode_fields(benchmark::State& state, Compression compression) {
  const Content content;
  for (auto _ : state) benchmark::DoNotOptimize(content.encode_fields(compression));
  report_vertices(state, content.vertices());
  state.SetBytesProcessed(state.iterations() * content.field_bytes());
}
BENCHMARK_CAPTURE(encode_fields, deflate, Compression::kDeflate)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(encode_fields, none, Compression::kNone)->Unit(benchmark::kMillisecond);

/// The whole way to the final name: encode, write, flush to the disk, read back, verify, rename.
void write_dataset(benchmark::State& state, Compression compression) {
  const tests::TemporaryFolder folder;
  const fs::path path = folder / "sphere.vtkhdf";
  const Content content;
  const PeakMemory memory;
  for (auto _ : state) write(path, content, compression);
  report_vertices(state, kLevels * content.vertices());
  report_memory(state, memory, content.vertices());
  state.counters["file_bytes_per_vertex_and_level"] =
      static_cast<double>(fs::file_size(path)) / static_cast<double>(kLevels * content.vertices());
}
BENCHMARK_CAPTURE(write_dataset, deflate, Compression::kDeflate)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(write_dataset, none, Compression::kNone)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// A dataset on the disk (in the page cache), and its size.
struct WrittenDataset {
  WrittenDataset() { write(path, content, Compression::kDeflate); }
  tests::TemporaryFolder folder;
  fs::path path = folder / "sphere.vtkhdf";
  Content content;
};

void verify_dataset(benchmark::State& state) {
  const WrittenDataset dataset;
  const PeakMemory memory;
  for (auto _ : state) io::Dataset(dataset.path).verify();
  report_vertices(state, kLevels * dataset.content.vertices());
  report_memory(state, memory, dataset.content.vertices());
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(fs::file_size(dataset.path)));
}
BENCHMARK(verify_dataset)->Unit(benchmark::kMillisecond);

void read_level(benchmark::State& state) {
  const WrittenDataset dataset;
  const io::Dataset reader(dataset.path);
  for (auto _ : state) {
    for (const char* name : {"points", "normals", "gaussian_curvature", "mean_curvature"})
      benchmark::DoNotOptimize(reader.read_floats(1, name));
    benchmark::DoNotOptimize(reader.read_integers(1, "triangles"));
  }
  report_vertices(state, dataset.content.vertices());
}
BENCHMARK(read_level)->Unit(benchmark::kMillisecond);

/// What a run costs for every dataset that is up to date, besides hashing its scan.
void read_job_key(benchmark::State& state) {
  const WrittenDataset dataset;
  for (auto _ : state) benchmark::DoNotOptimize(io::read_origin(dataset.path));
}
BENCHMARK(read_job_key)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace semigeo::bench
