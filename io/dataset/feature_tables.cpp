#include "io/dataset/feature_tables.hpp"

#include <cstddef>
#include <cstring>
#include <numeric>
#include <stdexcept>
#include <type_traits>

#include "io/hdf5/array_reader.hpp"

namespace semigeo::io {
namespace {

using kernels::Feature;
using kernels::kFeatureKinds;

// A row begins with the bytes of a Feature without its padding.
constexpr std::size_t kFeatureBytes = offsetof(FeatureRow, kind);
static_assert(std::is_standard_layout_v<Feature> && std::is_standard_layout_v<FeatureRow>);
static_assert(offsetof(Feature, vertex) == 0 && offsetof(Feature, value) == 8 &&
              offsetof(Feature, prominence) == 12 && offsetof(Feature, position) == 16 &&
              offsetof(Feature, initial_position) == 28 && offsetof(Feature, normal) == 40 &&
              offsetof(Feature, scale_free_gaussian) == 52 &&
              offsetof(Feature, scale_free_mean) == 56 && kFeatureBytes == 60);
static_assert(sizeof(FeatureRow) == size_of(ElementType::kFeature) &&
              sizeof(ContourRow) == size_of(ElementType::kContour));

/// Describes a table of a level.
struct Table {
  const char* name;
  EncodedArray EncodedFeatures::*encoded;
  ElementType type;
  int columns;

  std::string path(const std::string& level) const { return level + "/" + name; }
  bool fits(const ArrayShape& shape) const {
    return shape.type == type && shape.columns == columns;
  }
};
constexpr Table kFeatures = {"features", &EncodedFeatures::features, ElementType::kFeature, 1};
constexpr Table kContours = {"contours", &EncodedFeatures::contours, ElementType::kContour, 1};
constexpr Table kPoints = {"contour_points", &EncodedFeatures::contour_points,
                           ElementType::kFloat32, 4};

constexpr const char* kFeatureCounts = "feature_counts";
constexpr const char* kContourCounts = "contour_counts";
constexpr const char* kContourLengths = "contour_lengths";

template <typename Counts>
std::int64_t sum(const Counts& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

/// Describes the rows of one kind in a table whose rows are sorted by kind.
struct Rows {
  std::int64_t begin;
  std::int64_t end;
};
template <std::size_t kinds>
Rows rows_of(const std::array<std::int64_t, kinds>& counts, int kind) {
  const std::int64_t begin =
      std::accumulate(counts.begin(), counts.begin() + kind, std::int64_t{0});
  return {begin, begin + counts[kind]};
}

template <typename Row>
std::vector<Row> read_table(const Hdf5File& file, const std::string& level, const Table& table) {
  const std::vector<std::byte> bytes = read_records(file, table.path(level), table.type);
  std::vector<Row> rows(bytes.size() / sizeof(Row));
  if (!rows.empty()) std::memcpy(rows.data(), bytes.data(), bytes.size());
  return rows;
}

template <typename Value, std::size_t kinds>
std::array<Value, kinds> read_counts(const Hdf5File& file, const std::string& level,
                                     const char* name) {
  const auto values = file.read_attribute_as<std::vector<Value>>(level, name);
  if (values.size() != kinds)
    file.refuse(level, std::string("its attribute ") + name + " must have " +
                           std::to_string(kinds) + " values");
  std::array<Value, kinds> counts = {};
  std::copy(values.begin(), values.end(), counts.begin());
  return counts;
}

void check_type(const Hdf5File& file, const std::string& level, const Table& table) {
  if (!table.fits(file.shape_of(table.path(level))))
    file.refuse(table.path(level), "has not the type that this table must have");
}

template <std::size_t kinds>
void check_counts(const Hdf5File& file, const std::string& level, const Table& table,
                  const std::array<std::int64_t, kinds>& of_kind) {
  std::int64_t left = file.shape_of(table.path(level)).rows;
  for (const std::int64_t count : of_kind) {
    if (count < 0 || count > left) left = -1;
    if (left < 0) break;
    left -= count;
  }
  if (left != 0) file.refuse(table.path(level), "has not the rows that the level counts");
}

std::array<std::int64_t, kFeatureKinds> read_feature_counts(const Hdf5File& file,
                                                            const std::string& level) {
  const auto counts = read_counts<std::int64_t, kFeatureKinds>(file, level, kFeatureCounts);
  check_type(file, level, kFeatures);
  check_counts(file, level, kFeatures, counts);
  return counts;
}

template <typename Row>
void check_kind(const Hdf5File& file, const std::string& path, const Row& row, std::int64_t index,
                int kind) {
  if (row.kind != kind)
    file.refuse(path, "row " + std::to_string(index) + " is of kind " + std::to_string(row.kind) +
                          " among those of kind " + std::to_string(kind));
}

// Checks contours: each must have a point, and together they must have all points.
void check_contours(const Hdf5File& file, const std::string& path,
                    const std::vector<ContourRow>& contours, std::int64_t points) {
  std::int64_t next = 0;
  for (std::size_t i = 0; i < contours.size(); ++i) {
    const std::string name = "contour " + std::to_string(i);
    const ContourRow& contour = contours[i];
    if (contour.first != next)
      file.refuse(path, name + " begins at point " + std::to_string(contour.first) +
                            " instead of " + std::to_string(next));
    if (contour.count < 1 || contour.count > points - next)
      file.refuse(path, name + " has " + std::to_string(contour.count) + " points of " +
                            std::to_string(points - next));
    if (contour.closed != 0 && contour.closed != 1)
      file.refuse(path, name + " is marked neither 0 nor 1");
    next += contour.count;
  }
  if (next != points)
    file.refuse(path, "its contours end at point " + std::to_string(next) + " of " +
                          std::to_string(points));
}

void add_contours(const kernels::SampledContours& contours, int kind, FeatureTables& tables) {
  const auto before = static_cast<std::int64_t>(tables.contour_points.size());
  for (std::int64_t c = 0; c < contours.count(); ++c)
    tables.contours.push_back({.first = before + contours.offsets[c],
                               .count = contours.offsets[c + 1] - contours.offsets[c],
                               .kind = kind,
                               .closed = contours.closed[c]});
  for (std::size_t p = 0; p < contours.points.size(); ++p) {
    const Eigen::Vector3f& point = contours.points[p];
    tables.contour_points.push_back({point.x(), point.y(), point.z(), contours.torsion[p]});
  }
  tables.counts.contours[kind] = contours.count();
  tables.counts.contour_length[kind] = contours.length;
}

void add_features(const std::vector<Feature>& features, int kind, FeatureTables& tables) {
  for (const Feature& feature : features) {
    FeatureRow& row = tables.features.emplace_back();
    std::memcpy(static_cast<void*>(&row), static_cast<const void*>(&feature), kFeatureBytes);
    row.kind = kind;
    row.contour_point = -1;
  }
  tables.counts.of_kind[kind] = static_cast<std::int64_t>(features.size());
}

}  // namespace

std::int64_t FeatureCounts::total() const {
  return sum(of_kind);
}

FeatureTables tables_of(const kernels::LevelFeatures& features) {
  FeatureTables tables;
  for (int kind = 0; kind < kFeatureKinds; ++kind)
    add_features(features.of_kind[kind], kind, tables);
  for (int kind = 0; kind < kContourKinds; ++kind) {
    const auto before = static_cast<std::int64_t>(tables.contour_points.size());
    const std::vector<std::int64_t>& maxima = features.contours[kind].maxima;
    const Rows rows = rows_of(tables.counts.of_kind, torsion_of(kind));
    if (rows.end - rows.begin != static_cast<std::int64_t>(maxima.size()))
      throw std::invalid_argument("each maximum of torsion is a feature");
    for (std::size_t i = 0; i < maxima.size(); ++i)
      tables.features[rows.begin + i].contour_point = before + maxima[i];
    add_contours(features.contours[kind], kind, tables);
  }
  return tables;
}

ArrayView array_of(std::span<const FeatureRow> rows) {
  return detail::rows_of(rows, ElementType::kFeature, ElementType::kFeature, 1, {});
}

ArrayView array_of(std::span<const ContourRow> rows) {
  return detail::rows_of(rows, ElementType::kContour, ElementType::kContour, 1, {});
}

ArrayView array_of(std::span<const ContourPointRow> rows) {
  return detail::rows_of(rows, ElementType::kFloat32, ElementType::kFloat32, 4, {});
}

EncodedFeatures encode_features(const FeatureTables& tables, Compression compression) {
  EncodedFeatures encoded;
  for_each_array(tables, encoded, [&](const ArrayView& view, EncodedArray& target) {
    target = encode_array(view, compression);
  });
  return encoded;
}

void write_features(DigestedFile& file, const std::string& level, const EncodedFeatures& features) {
  const FeatureCounts& counts = features.counts;
  if (features.features.shape.rows != counts.total() ||
      features.contours.shape.rows != sum(counts.contours))
    throw std::invalid_argument(level + ": the counts do not fit the tables");
  const auto values = [](const auto& array) { return std::vector(array.begin(), array.end()); };
  file.write_attribute(level, kFeatureCounts, values(counts.of_kind));
  file.write_attribute(level, kContourCounts, values(counts.contours));
  file.write_attribute(level, kContourLengths, values(counts.contour_length));
  for (const Table& table : {kFeatures, kContours, kPoints}) {
    const EncodedArray& array = features.*table.encoded;
    if (!table.fits(array.shape))
      throw std::invalid_argument(table.path(level) + " has another type");
    file.write_array(table.path(level), array);
  }
}

FeatureCounts check_features(const Hdf5File& file, const std::string& level) {
  const FeatureCounts counts = {
      .of_kind = read_feature_counts(file, level),
      .contours = read_counts<std::int64_t, kContourKinds>(file, level, kContourCounts),
      .contour_length = read_counts<double, kContourKinds>(file, level, kContourLengths)};
  check_type(file, level, kContours);
  check_type(file, level, kPoints);
  check_counts(file, level, kContours, counts.contours);
  return counts;
}

kernels::FeaturesByKind read_features(const Hdf5File& file, const std::string& level,
                                      std::int64_t vertices) {
  const std::string path = kFeatures.path(level);
  const auto counts = read_feature_counts(file, level);
  const auto table = read_table<FeatureRow>(file, level, kFeatures);
  kernels::FeaturesByKind features;
  for (int kind = 0; kind < kFeatureKinds; ++kind) {
    const Rows rows = rows_of(counts, kind);
    features[kind].reserve(static_cast<std::size_t>(rows.end - rows.begin));
    for (std::int64_t i = rows.begin; i < rows.end; ++i) {
      check_kind(file, path, table[i], i, kind);
      Feature& feature = features[kind].emplace_back();
      std::memcpy(static_cast<void*>(&feature), &table[i], kFeatureBytes);
      if (feature.vertex < 0 || feature.vertex >= vertices)
        file.refuse(path, "row " + std::to_string(i) + " is at vertex " +
                              std::to_string(feature.vertex) + " of " + std::to_string(vertices));
    }
  }
  return features;
}

kernels::SampledContours read_contours(const Hdf5File& file, const std::string& level,
                                       kernels::FeatureKind kind) {
  const auto k = static_cast<int>(kind);
  if (k >= kContourKinds) throw std::invalid_argument("contours are of K = 0 or H = 0");
  const FeatureCounts counts = check_features(file, level);
  const std::vector<float> points = read_floats(file, kPoints.path(level), 4);
  const auto table = read_table<ContourRow>(file, level, kContours);
  check_contours(file, kContours.path(level), table, static_cast<std::int64_t>(points.size() / 4));
  kernels::SampledContours contours;
  contours.offsets = {0};
  const Rows rows = rows_of(counts.contours, k);
  const std::int64_t first = rows.begin < rows.end ? table[rows.begin].first : 0;
  std::int64_t end = first;
  for (std::int64_t c = rows.begin; c < rows.end; ++c) {
    check_kind(file, kContours.path(level), table[c], c, k);
    end += table[c].count;
    contours.offsets.push_back(end - first);
    contours.closed.push_back(static_cast<std::uint8_t>(table[c].closed));
  }
  for (std::int64_t at = 4 * first; at < 4 * end; at += 4) {
    contours.points.emplace_back(points[at], points[at + 1], points[at + 2]);
    contours.torsion.push_back(points[at + 3]);
  }
  const auto features = read_table<FeatureRow>(file, level, kFeatures);
  const Rows maxima = rows_of(counts.of_kind, torsion_of(k));
  for (std::int64_t i = maxima.begin; i < maxima.end; ++i) {
    check_kind(file, kFeatures.path(level), features[i], i, torsion_of(k));
    const std::int64_t point = features[i].contour_point;
    if (point < first || point >= end)
      file.refuse(kFeatures.path(level), "row " + std::to_string(i) + " is at point " +
                                             std::to_string(point) + ", outside its contours");
    contours.maxima.push_back(point - first);
  }
  contours.length = counts.contour_length[k];
  return contours;
}

}  // namespace semigeo::io
