#include "io/scans/feature_writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "io/files/error.hpp"
#include "io/files/output_file.hpp"

namespace semigeo::io {
namespace {

using kernels::Feature;
using kernels::FeatureKind;
using kernels::SampledContours;
using Origin = std::array<double, 3>;

/// Describes a column of a CSV, which is a property of vertices in a PLY.
struct Column {
  const char* name;
  const char* ply_type;  // nullptr stands for the type of coordinates
};
constexpr std::array<Column, 15> kFeatureColumns = {{
    {"x", nullptr},
    {"y", nullptr},
    {"z", nullptr},
    {"nx", "float"},
    {"ny", "float"},
    {"nz", "float"},
    {"value", "float"},
    {"prominence", "float"},
    {"scale_free_gaussian", "float"},
    {"scale_free_mean", "float"},
    {"initial_x", nullptr},
    {"initial_y", nullptr},
    {"initial_z", nullptr},
    {"kind", "uchar"},
    {"vertex", "int"},
}};
constexpr std::array<Column, 6> kContourColumns = {{
    {"x", nullptr},
    {"y", nullptr},
    {"z", nullptr},
    {"torsion", "float"},
    {"contour", "int"},
    {"closed", "uchar"},
}};

/// Writes rows as binary PLY has them: number after number.
class PlyRows {
 public:
  PlyRows(OutputFile& output, std::span<const Column> columns, const Placement& placement,
          std::size_t rows)
      : output_(output) {
    output.text(kPlyBegin + ("element vertex " + std::to_string(rows) + "\n"));
    for (const Column& column : columns)
      output.text(std::string("property ") +
                  (column.ply_type ? column.ply_type : placement.ply_type()) + " " + column.name +
                  "\n");
  }
  void end_header() { output_.text("end_header\n"); }

  template <typename Real>
  void real(Real value) {
    output_.number(value);
  }
  void index(std::int64_t value) {
    if (value > std::numeric_limits<std::int32_t>::max())
      throw Error(output_.path(), "", "would need " + std::to_string(value) + " as a PLY's int",
                  "write a .csv");
    output_.number(static_cast<std::int32_t>(value));
  }
  void mark(std::uint8_t value) { output_.number(value); }
  void kind(FeatureKind kind) { mark(static_cast<std::uint8_t>(kind)); }
  void end_row() {}

 private:
  OutputFile& output_;
};

/// Writes rows as lines. The first line has the names of the columns.
class CsvRows {
 public:
  CsvRows(OutputFile& output, std::span<const Column> columns) : output_(output) {
    for (const Column& column : columns) word(column.name);
    end_row();
  }

  template <typename Real>
  void real(Real value) {
    separate();
    output_.decimal(value);
  }
  void index(std::int64_t value) { real(value); }
  void mark(std::uint8_t value) { real(static_cast<int>(value)); }
  void kind(FeatureKind kind) { word(kernels::kFeatureKindNames[static_cast<int>(kind)]); }
  void end_row() {
    output_.text("\n");
    first_ = true;
  }

 private:
  void word(const char* text) {
    separate();
    output_.text(text);
  }
  void separate() {
    if (!first_) output_.text(",");
    first_ = false;
  }

  OutputFile& output_;
  bool first_ = true;
};

template <typename Rows>
void put_features(Rows& rows, std::span<const FeaturesView> tables, const Placement& placement) {
  const auto put = [&](auto coordinate) { rows.real(coordinate); };
  for (const FeaturesView& table : tables)
    for (const Feature& feature : table.features) {
      placement.place(feature.position.data(), put);
      for (const float component : feature.normal) rows.real(component);
      rows.real(feature.value);
      rows.real(feature.prominence);
      rows.real(feature.scale_free_gaussian);
      rows.real(feature.scale_free_mean);
      placement.place(feature.initial_position.data(), put);
      rows.kind(table.kind);
      rows.index(feature.vertex);
      rows.end_row();
    }
}

template <typename Rows>
void put_contours(Rows& rows, const SampledContours& contours, const Placement& placement) {
  for (std::int64_t c = 0; c < contours.count(); ++c)
    for (std::int64_t p = contours.offsets[c]; p < contours.offsets[c + 1]; ++p) {
      placement.place(contours.points[p].data(), [&](auto x) { rows.real(x); });
      rows.real(contours.torsion[p]);
      rows.index(c);
      rows.mark(contours.closed[c]);
      rows.end_row();
    }
}

/// Calls use(from, to) for every edge. Two points have one edge, whether closed or not.
template <typename Use>
void for_each_edge(const SampledContours& contours, const Use& use) {
  for (std::int64_t c = 0; c < contours.count(); ++c) {
    const std::int64_t begin = contours.offsets[c];
    const std::int64_t end = contours.offsets[c + 1];
    for (std::int64_t p = begin + 1; p < end; ++p) use(p - 1, p);
    if (contours.closed[c] == 1 && end - begin > 2) use(end - 1, begin);
  }
}

void check_shapes(const SampledContours& contours) {
  const std::vector<std::int64_t>& offsets = contours.offsets;
  if (contours.torsion.size() != contours.points.size() ||
      offsets.size() != contours.closed.size() + 1 || offsets.front() != 0 ||
      !std::is_sorted(offsets.begin(), offsets.end()) ||
      offsets.back() != static_cast<std::int64_t>(contours.points.size()))
    throw std::invalid_argument("contours whose arrays do not fit each other");
}

}  // namespace

void write_features_ply(const std::filesystem::path& path, std::span<const FeaturesView> tables,
                        const Origin& origin) {
  const Placement placement(origin);
  std::size_t count = 0;
  for (const FeaturesView& table : tables) count += table.features.size();
  OutputFile output(path);
  PlyRows rows(output, kFeatureColumns, placement, count);
  rows.end_header();
  put_features(rows, tables, placement);
  output.commit();
}

void write_features_csv(const std::filesystem::path& path, std::span<const FeaturesView> tables,
                        const Origin& origin) {
  OutputFile output(path);
  CsvRows rows(output, kFeatureColumns);
  put_features(rows, tables, Placement(origin));
  output.commit();
}

void write_contours_ply(const std::filesystem::path& path, const SampledContours& contours,
                        const Origin& origin) {
  check_shapes(contours);
  const Placement placement(origin);
  std::int64_t edges = 0;
  for_each_edge(contours, [&](auto, auto) { ++edges; });
  OutputFile output(path);
  PlyRows rows(output, kContourColumns, placement, contours.points.size());
  output.text("element edge " + std::to_string(edges) +
              "\nproperty int vertex1\nproperty int vertex2\n");
  rows.end_header();
  put_contours(rows, contours, placement);
  for_each_edge(contours, [&](std::int64_t from, std::int64_t to) {
    rows.index(from);
    rows.index(to);
  });
  output.commit();
}

void write_contours_csv(const std::filesystem::path& path, const SampledContours& contours,
                        const Origin& origin) {
  check_shapes(contours);
  OutputFile output(path);
  CsvRows rows(output, kContourColumns);
  put_contours(rows, contours, Placement(origin));
  output.commit();
}

}  // namespace semigeo::io
