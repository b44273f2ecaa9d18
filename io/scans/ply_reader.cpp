#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "io/scans/ply_decoder.hpp"
#include "io/scans/ply_header.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/triangle_strip.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kBadHeader = "correct the header or export the scan again";

Place declaration(const PlyElement& element) {
  return {Place::Unit::kLine, element.line};
}

/// The names of what is read of a vertex: its point and, if it has one, its normal.
constexpr std::array<std::string_view, 6> kVertexNames = {"x", "y", "z", "nx", "ny", "nz"};

/// Returns, for each property of `vertex`, its place in kVertexNames, or -1. Either all parts of
/// the normal have a place, or none.
std::vector<int> find_axes(const PlyElement& vertex, const ScanBuilder& builder) {
  std::vector<int> axes(vertex.properties.size(), -1);
  int normals = 0;
  for (int axis = 0; axis < std::ssize(kVertexNames); ++axis) {
    const auto found = std::find_if(
        vertex.properties.begin(), vertex.properties.end(),
        [&](const PlyProperty& p) { return p.name == kVertexNames[axis] && !p.count_type; });
    if (found != vertex.properties.end()) {
      axes[found - vertex.properties.begin()] = axis;
      if (axis >= 3) ++normals;
    } else if (axis < 3) {
      builder.fail(declaration(vertex),
                   "its vertices have no property " + std::string(kVertexNames[axis]), kBadHeader);
    }
  }
  if (normals < 3)
    std::ranges::replace_if(
        axes, [](int axis) { return axis >= 3; }, -1);
  return axes;
}

/// Returns the list of `element` that holds its vertex indices.
const PlyProperty& find_index_list(const PlyElement& element, const ScanBuilder& builder) {
  for (const PlyProperty& property : element.properties) {
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    if (property.count_type && is_integer(property.type)) return property;
    builder.fail(declaration(element), property.name + " is not a list of integers", kBadHeader);
  }
  builder.fail(declaration(element),
               "element " + element.name + " has no list vertex_indices or vertex_index",
               kBadHeader);
}

/// Returns the number of vertices that the header promises.
std::int64_t vertex_count(const PlyHeader& header) {
  for (const PlyElement& element : header.elements)
    if (element.name == "vertex") return element.count;
  return 0;
}

/// Returns the scanner's grid if the scan has no faces, or nullptr. Throws Error if the header does
/// not say what size the grid has.
const PlyElement* find_grid(const PlyHeader& header, const ScanBuilder& builder) {
  const PlyElement* grid = nullptr;
  for (const PlyElement& element : header.elements) {
    if (element.count == 0) continue;
    if (element.name == "face" || element.name == "tristrips") return nullptr;
    if (element.name == "range_grid") grid = &element;
  }
  if (grid == nullptr) return nullptr;
  if (!header.grid_rows || !header.grid_columns)
    builder.fail(declaration(*grid),
                 "the size of range_grid is unknown: the lines 'obj_info num_rows' and 'obj_info "
                 "num_cols' are missing",
                 kBadHeader);
  const std::int64_t rows = *header.grid_rows;
  const std::int64_t columns = *header.grid_columns;
  if (rows <= 0 || columns <= 0 || grid->count / columns != rows || grid->count % columns != 0)
    builder.fail(declaration(*grid),
                 "range_grid has " + std::to_string(grid->count) + " cells, but num_rows is " +
                     std::to_string(rows) + " and num_cols is " + std::to_string(columns),
                 kBadHeader);
  return grid;
}

/// Reads the elements in the order of the file.
template <typename Decoder>
class PlyBody {
 public:
  PlyBody(ByteSource& source, const PlyHeader& header, ScanBuilder& builder)
      : header_(header),
        builder_(builder),
        decoder_(source, header, builder),
        grid_element_(find_grid(header, builder)) {}

  void read() {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face" && element.count > 0) {
        read_faces(element);
      } else if (element.name == "tristrips" && element.count > 0) {
        read_strips(element);
      } else if (&element == grid_element_) {
        read_grid(element);
      } else {
        skip(element);
      }
    }
    if (grid_element_ != nullptr) builder_.add_grid(std::move(grid_), declaration(*grid_element_));
  }

 private:
  void read_vertices(const PlyElement& element) {
    const std::vector<int> axes = find_axes(element, builder_);
    const bool normals = std::ranges::find(axes, 3) != axes.end();
    std::array<double, 6> values{};
    for (std::int64_t i = 0; i < element.count; ++i) {
      decoder_.begin_record(element, i);
      for (std::size_t p = 0; p < axes.size(); ++p) {
        if (axes[p] < 0) {
          decoder_.skip(element.properties[p]);
        } else {
          values[axes[p]] = decoder_.scalar(element.properties[p]);
        }
      }
      builder_.add_point(values[0], values[1], values[2], decoder_.place());
      if (normals)
        builder_.add_normal(i, Eigen::Vector3d(values[3], values[4], values[5]).cast<float>());
      decoder_.end_record();
    }
  }

  /// Calls `use(property, length)` for the index list of every record, in place of reading it.
  template <typename Use>
  void read_lists(const PlyElement& element, Use use) {
    const PlyProperty& list = find_index_list(element, builder_);
    for (std::int64_t i = 0; i < element.count; ++i) {
      decoder_.begin_record(element, i);
      for (const PlyProperty& property : element.properties) {
        if (&property == &list) {
          use(list, decoder_.length(list));
        } else {
          decoder_.skip(property);
        }
      }
      decoder_.end_record();
    }
  }

  void read_faces(const PlyElement& element) {
    std::vector<std::int64_t> corners;
    read_lists(element, [&](const PlyProperty& list, std::int64_t length) {
      builder_.check_corner_count(length, decoder_.place());
      corners.clear();
      decoder_.items(list, length, [&](std::int64_t corner) { corners.push_back(corner); });
      builder_.add_face(corners, decoder_.place());
    });
  }

  void read_strips(const PlyElement& element) {
    read_lists(element, [&](const PlyProperty& list, std::int64_t length) {
      TriangleStrip strip;
      decoder_.items(list, length, [&](std::int64_t corner) {
        if (corner == -1) {
          strip.restart();
        } else if (const auto triangle = strip.next(corner)) {
          builder_.add_face(*triangle, decoder_.place());
        }
      });
    });
  }

  /// Reads the rays of a scanner's grid: each is a list of one vertex, or of none.
  void read_grid(const PlyElement& element) {
    grid_.rows = *header_.grid_rows;
    grid_.columns = *header_.grid_columns;
    const std::int64_t vertices = vertex_count(header_);
    read_lists(element, [&](const PlyProperty& list, std::int64_t length) {
      if (length > 1)
        builder_.fail(decoder_.place(),
                      "a cell of the grid has " + std::to_string(length) + " vertices, not 0 or 1",
                      "export the scan again");
      std::int32_t cell = -1;
      decoder_.items(list, length, [&](std::int64_t vertex) {
        if (vertex < 0 || vertex >= vertices)
          builder_.fail(decoder_.place(),
                        "a cell of the grid refers to vertex " + std::to_string(vertex) +
                            ", but there are only " + std::to_string(vertices) +
                            " vertices, numbered from 0",
                        "copy the file again from its source or export it again");
        cell = static_cast<std::int32_t>(vertex);
      });
      grid_.cells.push_back(cell);
    });
  }

  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;  // its records have no bytes, however many there are
    for (std::int64_t i = 0; i < element.count; ++i) {
      decoder_.begin_record(element, i);
      for (const PlyProperty& property : element.properties) decoder_.skip(property);
      decoder_.end_record();
    }
  }

  const PlyHeader& header_;
  ScanBuilder& builder_;
  Decoder decoder_;
  const PlyElement* const grid_element_;
  kernels::RangeGrid grid_;
};

/// Tells the builder what the header promises. The builder must know it before the first element is
/// read, because faces may come before vertices.
void announce(const PlyHeader& header, ScanBuilder& builder) {
  const bool ascii = header.encoding == PlyHeader::Encoding::kAscii;
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    const std::int64_t bytes = std::max<std::int64_t>(element.least_bytes(ascii), 1);
    if (element.name == "vertex") {
      if (has_vertices)
        builder.fail(declaration(element), "element vertex is declared twice", kBadHeader);
      has_vertices = true;
      find_axes(element, builder);
      builder.promise_points(element.count, bytes, declaration(element));
    } else if (element.name == "face") {
      builder.promise_faces(element.count, bytes, declaration(element));
    }
  }
  if (!has_vertices)
    builder.fail({Place::Unit::kLine, header.lines}, "the header declares no element vertex",
                 kBadHeader);
}

Scan read_ply(ByteSource& source, const ScanOptions& options) {
  const PlyHeader header = read_ply_header(source);
  ScanBuilder builder(source, options);
  announce(header, builder);
  builder.add_unknown_header_lines(header.unknown_lines);
  if (header.encoding == PlyHeader::Encoding::kAscii) {
    PlyBody<PlyAsciiDecoder>(source, header, builder).read();
    return builder.finish("PLY ascii");
  }
  PlyBody<PlyBinaryDecoder>(source, header, builder).read();
  return builder.finish(header.encoding == PlyHeader::Encoding::kBigEndian
                            ? "PLY binary big endian"
                            : "PLY binary little endian");
}

std::string variant_of(std::string_view begin) {
  return begin.find("format ascii") != std::string_view::npos ? "PLY ascii" : "PLY binary";
}

}  // namespace

const ScanFormat kPlyFormat = {.extension = ".ply",
                               .read = read_ply,
                               .variant = variant_of,
                               .content = "meshes, triangle strips, range grids",
                               .variants = "ascii, binary of either byte order"};

}  // namespace semigeo::io
