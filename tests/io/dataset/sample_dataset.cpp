#include "tests/io/dataset/sample_dataset.hpp"

namespace semigeo::tests {
namespace {

kernels::Feature sample_feature(std::int64_t vertices, int level, int kind, int i) {
  const auto k = static_cast<float>(level);
  const auto j = static_cast<float>(kind);
  const auto x = static_cast<float>(i);
  return {.vertex = i % vertices,
          .value = x - j,
          .prominence = 0.5F * x,
          .position = {x, j, k},
          .initial_position = {x, j, -1},
          .normal = {0, k, 1},
          .scale_free_gaussian = 0.25F * x,
          .scale_free_mean = -0.25F * x};
}

// Contour i has 3 + i points; every other one is closed. The first points are the maxima.
kernels::SampledContours sample_contours(int level, int kind, std::size_t maxima) {
  kernels::SampledContours contours;
  contours.offsets = {0};
  for (int i = 0; i < level * (2 + kind); ++i) {
    contours.closed.push_back(static_cast<std::uint8_t>(i % 2));
    contours.offsets.push_back(contours.offsets.back() + 3 + i);
  }
  for (int p = 0; p < contours.offsets.back(); ++p) {
    contours.points.emplace_back(0.5F * static_cast<float>(p), kind, level);
    contours.torsion.push_back(static_cast<float>(p - kind));
  }
  for (std::size_t m = 0; m < maxima; ++m) contours.maxima.push_back(static_cast<std::int64_t>(m));
  contours.length = 2.5 * static_cast<double>(contours.offsets.back());
  return contours;
}

kernels::LevelFeatures sample_features(std::int64_t vertices, int level) {
  kernels::LevelFeatures features;
  for (int kind = 0; kind < kernels::kFeatureKinds; ++kind)
    for (int i = 0; i < level * (5 + kind); ++i)
      features.of_kind[kind].push_back(sample_feature(vertices, level, kind, i));
  for (int kind = 0; kind < io::kContourKinds; ++kind)
    features.contours[kind] =
        sample_contours(level, kind, features.of_kind[io::torsion_of(kind)].size());
  return features;
}

}  // namespace

SampleLevel sample_level(const Sample& sample, int level) {
  SampleLevel result;
  result.attributes = {.iteration = level,
                       .step = 0.5,
                       .scale = 0.25 + level,
                       .mean_edge_length = 1.5,
                       .parts = 1 + (sample.vertices - 1) / 1000,
                       .shortest_side = 0.125,
                       .remeshed = {.flipped = 7,
                                    .split = 1,
                                    .collapsed = 2,
                                    .torn = 3,
                                    .inserted = 4,
                                    .removed = 5,
                                    .dropped_parts = 6}};
  for (std::int64_t i = 0; i < sample.vertices_of(level); ++i) {
    const auto x = static_cast<float>(i);
    const auto k = static_cast<float>(level);
    result.points.emplace_back(0.25F * x, k, static_cast<float>(i * 7919 % 1000) / 8);
    result.normals.emplace_back(0.0F, k, 1.0F);
    result.gaussian_curvature.push_back(0.5F * x - k);
    result.mean_curvature.push_back(k - 0.5F * x);
    result.patch_completeness.push_back(static_cast<float>(i % 2));
    result.source_vertex.push_back(i % 10 == 9 ? -1 : static_cast<std::int32_t>(i));
    result.part.push_back(static_cast<std::int32_t>(i / 1000));
  }
  const auto vertices = static_cast<std::int32_t>(sample.vertices_of(level));
  for (std::int32_t f = 0; f < sample.triangles_of(level); ++f)
    result.triangles.push_back({f % vertices, (f + 1) % vertices, (f + 2) % vertices});
  result.features = sample_features(sample.vertices_of(level), level);
  return result;
}

io::DatasetHeader sample_header() {
  return {.parameters = {{"levels", 3}},
          .input_name = "vases/Krug Nº 7.ply",
          .input_xxh3 = "0123456789abcdef0123456789abcdef",
          .job_key = "key-of-the-job",
          .length_unit = "mm",
          .repairs = {{"duplicate_faces", 2}},
          .preparation = {{"holes", 1}},
          .origin = {1000.5, -2, 3}};
}

io::EncodedFields encode_fields(const SampleLevel& level, io::Compression compression) {
  const auto encode = [&](const auto& values) {
    return io::encode_array(io::array_of(std::span(values)), compression);
  };
  return {encode(level.points),
          encode(level.normals),
          encode(level.gaussian_curvature),
          encode(level.mean_curvature),
          encode(level.patch_completeness),
          io::encode_features(io::tables_of(level.features), compression),
          std::nullopt};
}

io::EncodedConnectivity encode_connectivity(const SampleLevel& level, io::Compression compression) {
  return {io::encode_array(io::array_of(std::span(level.triangles)), compression),
          io::encode_array(io::array_of(level.source_vertex, io::ElementType::kInt64), compression),
          io::encode_array(io::array_of(level.part), compression)};
}

io::Selection sample_selection(const Sample& sample) {
  io::Selection selection;
  for (int k = 0; k < sample.levels; ++k) {
    selection.feature_counts.push_back(k * (5 + 6 + 7 + 8));
    selection.smoothed.push_back(static_cast<double>(selection.feature_counts.back()) + 0.5);
  }
  selection.level = sample.levels - 1;
  selection.chosen = sample.changing ? io::Chosen::kOption : io::Chosen::kSlope;
  return selection;
}

std::string write_sample(const std::filesystem::path& path, const Sample& sample) {
  io::DatasetWriter writer(path, sample_header(), sample.compression);
  for (int k = 0; k < sample.levels; ++k) {
    const SampleLevel level = sample_level(sample, k);
    if (k == 0 || sample.changing)
      writer.write_connectivity(encode_connectivity(level, sample.compression));
    writer.write_level(level.attributes, encode_fields(level, sample.compression));
  }
  writer.write_selection(sample_selection(sample));
  return writer.finish();
}

}  // namespace semigeo::tests
