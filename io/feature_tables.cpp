#include "io/feature_tables.hpp"

#include <cstring>
#include <numeric>
#include <stdexcept>
#include <type_traits>

#include "io/array_reader.hpp"

namespace semigeo::io {
namespace {

using kernels::Feature;
using kernels::kFeatureKindNames;
using kernels::kFeatureKinds;

// A record is the beginning of a Feature, byte by byte.
constexpr std::size_t kRecordBytes = size_of(ElementType::feature);
static_assert(std::is_standard_layout_v<Feature>);
static_assert(offsetof(Feature, vertex) == 0 && offsetof(Feature, value) == 8 &&
              offsetof(Feature, prominence) == 12 && offsetof(Feature, position) == 16 &&
              offsetof(Feature, initial_position) == 28 && offsetof(Feature, normal) == 40 &&
              offsetof(Feature, scale_free_gaussian) == 52 &&
              offsetof(Feature, scale_free_mean) == 56 && kRecordBytes == 60);

std::string table_path(const std::string& level, int kind) {
  return level + "/features/" + kFeatureKindNames[kind];
}

std::string contours_path(const std::string& level, int kind) {
  return level + "/contours/" + kFeatureKindNames[kind];
}

/// An array of one kind of contours.
struct ContourArray {
  const char* name;
  EncodedArray EncodedContours::*encoded;
  ElementType type;
  int columns;

  bool fits(const ArrayShape& shape, std::int64_t rows) const {
    return shape.type == type && shape.columns == columns && shape.rows == rows;
  }
};
constexpr std::size_t kContourArrayCount = 5;
constexpr std::array<ContourArray, kContourArrayCount> kContourArrays = {{
    {"points", &EncodedContours::points, ElementType::float32, 3},
    {"torsion", &EncodedContours::torsion, ElementType::float32, 1},
    {"offsets", &EncodedContours::offsets, ElementType::int64, 1},
    {"closed", &EncodedContours::closed, ElementType::uint8, 1},
    {"maxima", &EncodedContours::maxima, ElementType::int64, 1},
}};

/// The rows that each of them must have.
std::array<std::int64_t, kContourArrayCount> contour_rows(std::int64_t points,
                                                          std::int64_t contours,
                                                          std::int64_t maxima) {
  return {points, points, contours + 1, contours, maxima};
}

bool is_table(const ArrayShape& shape) {
  return shape.type == ElementType::feature && shape.columns == 1;
}

void write_contours(DigestedFile& file, const std::string& group, const EncodedContours& contours,
                    std::int64_t maxima) {
  const std::int64_t count = contours.closed.shape.rows;
  file.create_group(group);
  file.write_attribute(group, "length", contours.length);
  file.write_attribute(group, "count", count);
  const auto rows = contour_rows(contours.points.shape.rows, count, maxima);
  for (std::size_t i = 0; i < kContourArrayCount; ++i) {
    const std::string path = group + "/" + kContourArrays[i].name;
    const EncodedArray& array = contours.*kContourArrays[i].encoded;
    if (!kContourArrays[i].fits(array.shape, rows[i]))
      throw std::invalid_argument(path + " does not fit the other arrays");
    file.write_array(path, array);
  }
}

// Contours as they must be: each has a point, and together they have all.
void check_contours(const Hdf5File& file, const std::string& group,
                    const kernels::SampledContours& contours) {
  const auto points = static_cast<std::int64_t>(contours.points.size());
  const std::vector<std::int64_t>& offsets = contours.offsets;
  const std::string place = group + "/offsets";
  if (offsets.front() != 0) file.refuse(place, "does not begin at point 0");
  for (std::size_t i = 1; i < offsets.size(); ++i)
    if (offsets[i] <= offsets[i - 1])
      file.refuse(place, "contour " + std::to_string(i - 1) + " has no points");
  if (offsets.back() != points)
    file.refuse(
        place, "ends at point " + std::to_string(offsets.back()) + " of " + std::to_string(points));
  for (const std::int64_t point : contours.maxima)
    if (point < 0 || point >= points)
      file.refuse(group + "/maxima",
                  "refers to point " + std::to_string(point) + " of " + std::to_string(points));
}

}  // namespace

ArrayView array_of(std::span<const Feature> features) {
  return detail::rows_of(features, ElementType::feature, ElementType::feature, 1, {});
}

EncodedFeatures encode_features(const kernels::LevelFeatures& features, Compression compression) {
  EncodedFeatures encoded;
  for_each_array(features, encoded, [&](const ArrayView& view, EncodedArray& target) {
    target = encode_array(view, compression);
  });
  return encoded;
}

std::int64_t FeatureCounts::total() const {
  return std::accumulate(of_kind.begin(), of_kind.end(), std::int64_t{0});
}

FeatureCounts counts_of(const EncodedFeatures& features) {
  FeatureCounts counts;
  for (int kind = 0; kind < kFeatureKinds; ++kind)
    counts.of_kind[kind] = features.of_kind[kind].shape.rows;
  for (int kind = 0; kind < kContourKinds; ++kind) {
    counts.contours[kind] = features.contours[kind].closed.shape.rows;
    counts.contour_length[kind] = features.contours[kind].length;
  }
  return counts;
}

void write_features(DigestedFile& file, const std::string& level, const EncodedFeatures& features) {
  file.create_group(level + "/features");
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    if (!is_table(features.of_kind[kind].shape))
      throw std::invalid_argument(table_path(level, kind) + " is no table of features");
    file.write_array(table_path(level, kind), features.of_kind[kind]);
  }
  file.create_group(level + "/contours");
  for (int kind = 0; kind < kContourKinds; ++kind)
    write_contours(file, contours_path(level, kind), features.contours[kind],
                   features.of_kind[torsion_of(kind)].shape.rows);
}

FeatureCounts check_features(const Hdf5File& file, const std::string& level) {
  FeatureCounts counts;
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    const std::string table = table_path(level, kind);
    const ArrayShape shape = file.shape_of(table);
    if (!is_table(shape)) file.refuse(table, "is no table of features");
    counts.of_kind[kind] = shape.rows;
  }
  for (int kind = 0; kind < kContourKinds; ++kind) {
    const std::string group = contours_path(level, kind);
    counts.contours[kind] = file.read_attribute_as<std::int64_t>(group, "count");
    counts.contour_length[kind] = file.read_attribute_as<double>(group, "length");
    std::array<ArrayShape, kContourArrayCount> shapes;
    for (std::size_t i = 0; i < kContourArrayCount; ++i)
      shapes[i] = file.shape_of(group + "/" + kContourArrays[i].name);
    const auto rows =
        contour_rows(shapes[0].rows, counts.contours[kind], counts.of_kind[torsion_of(kind)]);
    for (std::size_t i = 0; i < kContourArrayCount; ++i)
      if (!kContourArrays[i].fits(shapes[i], rows[i]))
        file.refuse(group + "/" + kContourArrays[i].name,
                    "has not the type or shape that its contours must have");
  }
  return counts;
}

std::vector<Feature> read_features(const Hdf5File& file, const std::string& level,
                                   kernels::FeatureKind kind, std::int64_t vertices) {
  const std::string path = table_path(level, static_cast<int>(kind));
  const std::vector<std::byte> records = read_records(file, path, ElementType::feature);
  std::vector<Feature> features(records.size() / kRecordBytes);
  for (std::size_t i = 0; i < features.size(); ++i) {
    std::memcpy(static_cast<void*>(&features[i]), records.data() + i * kRecordBytes, kRecordBytes);
    if (features[i].vertex < 0 || features[i].vertex >= vertices)
      file.refuse(path, "feature " + std::to_string(i) + " is at vertex " +
                            std::to_string(features[i].vertex) + " of " + std::to_string(vertices));
  }
  return features;
}

kernels::SampledContours read_contours(const Hdf5File& file, const std::string& level,
                                       kernels::FeatureKind kind) {
  if (static_cast<int>(kind) >= kContourKinds)
    throw std::invalid_argument("contours are of K = 0 or H = 0");
  const std::string group = contours_path(level, static_cast<int>(kind));
  kernels::SampledContours contours;
  const std::vector<float> points = read_floats(file, group + "/points", 3);
  for (std::size_t at = 0; at < points.size(); at += 3)
    contours.points.emplace_back(points[at], points[at + 1], points[at + 2]);
  contours.torsion = read_floats(file, group + "/torsion", 1);
  contours.offsets = read_integers(file, group + "/offsets", 1);
  for (const std::int64_t mark : read_integers(file, group + "/closed", 1)) {
    if (mark > 1) file.refuse(group + "/closed", "a mark is neither 0 nor 1");
    contours.closed.push_back(static_cast<std::uint8_t>(mark));
  }
  contours.maxima = read_integers(file, group + "/maxima", 1);
  contours.length = file.read_attribute_as<double>(group, "length");
  check_contours(file, group, contours);
  return contours;
}

}  // namespace semigeo::io
