#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/dataset/dataset_header.hpp"
#include "io/dataset/dataset_writer.hpp"

namespace semigeo::tests {

/// A dataset whose every value is a formula of level and index (see sample_dataset.cpp), which the
/// tests in C++ and in Python compute again.
struct Sample {
  int levels = 3;
  bool changing = false;         ///< from level 1 on each level brings its own connectivity
  std::int64_t vertices = 5000;  ///< of level 0; a changing level k has 100 k fewer
  std::int64_t triangles = 9000;
  io::Compression compression = io::Compression::kDeflate;

  std::int64_t vertices_of(int level) const { return vertices - (changing ? 100 * level : 0); }
  std::int64_t triangles_of(int level) const { return triangles - (changing ? 50 * level : 0); }
};

struct SampleLevel {
  io::LevelAttributes attributes;
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> gaussian_curvature;
  std::vector<float> mean_curvature;
  std::vector<float> patch_completeness;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source_vertex;
  std::vector<std::int32_t> part;
  kernels::LevelFeatures features;  ///< level 0 has none, and no contours
};

SampleLevel sample_level(const Sample& sample, int level);
io::DatasetHeader sample_header();
io::EncodedFields encode_fields(const SampleLevel& level, io::Compression compression);
io::EncodedConnectivity encode_connectivity(const SampleLevel& level, io::Compression compression);
/// Counts of the levels' features, and a level.
io::Selection sample_selection(const Sample& sample);

/// Returns the content digest.
std::string write_sample(const std::filesystem::path& path, const Sample& sample = {});

}  // namespace semigeo::tests
