#include "tests/io/sample_dataset.hpp"

namespace semigeo::tests {

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
  return result;
}

io::DatasetHeader sample_header() {
  return {.parameters_json = R"({"levels": 3})",
          .input_name = "vases/Krug Nº 7.ply",
          .input_xxh3 = "0123456789abcdef0123456789abcdef",
          .job_key = "key-of-the-job",
          .length_unit = "mm",
          .repairs_json = R"({"duplicate_faces": 2})",
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
          std::nullopt};
}

io::EncodedConnectivity encode_connectivity(const SampleLevel& level, io::Compression compression) {
  return {io::encode_array(io::array_of(std::span(level.triangles)), compression),
          io::encode_array(io::array_of(level.source_vertex, io::ElementType::int64), compression),
          io::encode_array(io::array_of(level.part), compression)};
}

std::string write_sample(const std::filesystem::path& path, const Sample& sample) {
  io::DatasetWriter writer(path, sample_header(), sample.compression);
  for (int k = 0; k < sample.levels; ++k) {
    const SampleLevel level = sample_level(sample, k);
    if (k == 0 || sample.changing)
      writer.write_connectivity(encode_connectivity(level, sample.compression));
    writer.write_level(level.attributes, encode_fields(level, sample.compression));
  }
  return writer.finish();
}

}  // namespace semigeo::tests
