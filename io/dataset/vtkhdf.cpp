#include "io/dataset/vtkhdf.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace semigeo::io {
namespace {

using Table = VtkhdfLayout::Table;

constexpr std::array<const char*, 3> kEmptyCategories = {"Vertices", "Lines", "Strips"};
constexpr int kCategories = 4;  // columns of the step tables: Vertices, Lines, Polygons, Strips
constexpr int kPolygons = 2;
constexpr int kCorners = 3;

std::string parent_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "" : path.substr(0, slash);
}

// Returns where each step begins in an array that holds `counts` elements of each step.
std::vector<std::int64_t> starts(const std::vector<std::int64_t>& counts) {
  std::vector<std::int64_t> result;
  std::int64_t sum = 0;
  for (const std::int64_t count : counts) {
    result.push_back(sum);
    sum += count;
  }
  return result;
}

Table polygon_column(const std::vector<std::int64_t>& values) {
  Table table{kCategories, std::vector<std::int64_t>(kCategories * values.size(), 0)};
  for (std::size_t k = 0; k < values.size(); ++k)
    table.values[kCategories * k + kPolygons] = values[k];
  return table;
}

void add_views(VtkhdfLayout& layout, std::span<const VtkhdfStep> steps, std::size_t parts) {
  VtkhdfLayout::View points{ElementType::kFloat32, 3, {}};
  for (const VtkhdfStep& step : steps)
    points.pieces.push_back({step.level + "/points", step.vertices});
  layout.views["Points"] = std::move(points);
  for (const VtkhdfPointArray& array : point_arrays_of(steps.front())) {
    VtkhdfLayout::View view{array.type, array.columns, {}};
    for (const VtkhdfStep& step : steps)
      view.pieces.push_back({step.level + "/" + array.source, step.vertices});
    layout.views[std::string("PointData/") + array.name] = std::move(view);
  }
  VtkhdfLayout::View connectivity{ElementType::kInt64, 1, {}};
  for (std::size_t k = 0; k < parts; ++k)
    connectivity.pieces.push_back({steps[k].level + "/triangles", kCorners * steps[k].triangles});
  layout.views["Polygons/Connectivity"] = std::move(connectivity);
}

// Writes the offsets 3 i of the triangles. Each part has one more offset than triangles and begins
// with 0 again. They are encoded chunk by chunk, because all together would take more memory than
// the triangles.
EncodedArray encode_offsets(const std::vector<std::int64_t>& triangles_of_part,
                            Compression compression) {
  ArrayView view{ElementType::kInt64, ElementType::kInt64};
  for (const std::int64_t triangles : triangles_of_part) view.rows += triangles + 1;
  EncodedArray array{shape_of(view, compression), {}};
  std::size_t part = 0;
  std::int64_t within = 0;
  std::vector<std::int64_t> rows;
  for (std::int64_t i = 0; i < array.shape.chunk_count(); ++i) {
    rows.resize(static_cast<std::size_t>(array.shape.rows_in_chunk(i)));
    for (std::int64_t& row : rows) {
      row = kCorners * within++;
      if (within > triangles_of_part[part]) {
        ++part;
        within = 0;
      }
    }
    array.chunks.push_back(encode_rows(array.shape, std::as_bytes(std::span(rows))));
  }
  return array;
}

void create_groups(DigestedFile& file, const VtkhdfLayout& layout) {
  std::set<std::string> groups = {""};
  for (const auto& [path, table] : layout.tables) groups.insert(parent_of(path));
  for (const auto& [path, view] : layout.views) groups.insert(parent_of(path));
  for (const std::string& group : groups)
    file.create_group(group.empty() ? "/VTKHDF" : "/VTKHDF/" + group);
}

}  // namespace

std::vector<VtkhdfPointArray> point_arrays_of(const VtkhdfStep& step) {
  std::vector<VtkhdfPointArray> arrays;
  for (const VtkhdfPointArray& array : kVtkhdfPointArrays)
    if (array.presence == Presence::kAlways ||
        (array.presence == Presence::kPrincipal && step.principal) ||
        (array.presence == Presence::kFilled && step.filled))
      arrays.push_back(array);
  return arrays;
}

VtkhdfLayout vtkhdf_layout(std::span<const VtkhdfStep> steps) {
  const bool changes = std::any_of(steps.begin() + 1, steps.end(),
                                   [](const VtkhdfStep& step) { return step.new_connectivity; });
  const std::size_t parts = changes ? steps.size() : 1;
  VtkhdfLayout layout;
  layout.steps = static_cast<std::int64_t>(steps.size());
  std::vector<std::int64_t> vertices;
  std::vector<std::int64_t> corners;
  for (const VtkhdfStep& step : steps) {
    layout.values.push_back(step.value);
    vertices.push_back(step.vertices);
    corners.push_back(kCorners * step.triangles);
  }
  std::vector<std::int64_t> part_of_step(steps.size(), 0);
  std::vector<std::int64_t> first_cell(steps.size(), 0);
  std::vector<std::int64_t> first_corner(steps.size(), 0);
  for (std::size_t k = 0; k < parts; ++k) layout.triangles_of_part.push_back(steps[k].triangles);
  if (changes) {
    for (std::size_t k = 0; k < parts; ++k) part_of_step[k] = static_cast<std::int64_t>(k);
    first_cell = starts(layout.triangles_of_part);
    first_corner = starts(corners);
  }
  corners.resize(parts);

  std::map<std::string, Table>& tables = layout.tables;
  tables["NumberOfPoints"] = {1, {vertices.begin(), vertices.begin() + static_cast<int>(parts)}};
  tables["Steps/NumberOfParts"] = {1, std::vector<std::int64_t>(steps.size(), 1)};
  tables["Steps/PartOffsets"] = {1, part_of_step};
  tables["Steps/PointOffsets"] = {1, starts(vertices)};
  tables["Steps/CellOffsets"] = polygon_column(first_cell);
  tables["Steps/ConnectivityIdOffsets"] = polygon_column(first_corner);
  for (const VtkhdfPointArray& array : point_arrays_of(steps.front()))
    tables[std::string("Steps/PointDataOffsets/") + array.name] = {1, starts(vertices)};
  tables["Polygons/NumberOfCells"] = {1, layout.triangles_of_part};
  tables["Polygons/NumberOfConnectivityIds"] = {1, corners};
  for (const std::string category : kEmptyCategories) {
    const std::vector<std::int64_t> none(parts, 0);
    tables[category + "/NumberOfCells"] = {1, none};
    tables[category + "/NumberOfConnectivityIds"] = {1, none};
    tables[category + "/Offsets"] = {1, none};  // each part has one more offset than cells
    tables[category + "/Connectivity"] = {1, {}};
  }
  add_views(layout, steps, parts);
  return layout;
}

void write_vtkhdf(DigestedFile& file, const VtkhdfLayout& layout, Compression compression) {
  create_groups(file, layout);
  file.write_attribute("/VTKHDF", "Type", layout.type);
  file.write_attribute("/VTKHDF", "Version", layout.version);
  file.write_attribute("/VTKHDF/Steps", "NSteps", layout.steps);
  file.write_array("/VTKHDF/Steps/Values", encode_array(array_of(layout.values), compression));
  for (const auto& [path, table] : layout.tables) {
    ArrayView view = array_of(table.values);
    view.columns = table.columns;
    view.rows /= table.columns;
    view.row_stride *= table.columns;
    file.write_array("/VTKHDF/" + path, encode_array(view, compression));
  }
  file.write_array("/VTKHDF/Polygons/Offsets",
                   encode_offsets(layout.triangles_of_part, compression));
  for (const auto& [path, view] : layout.views)
    file.write_virtual("/VTKHDF/" + path, view.type, view.columns, view.pieces);
}

}  // namespace semigeo::io
