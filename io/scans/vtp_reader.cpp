#include <algorithm>
#include <bit>
#include <cstdint>
#include <pugixml.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/printable.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/vtk_cells.hpp"
#include "io/scans/vtp_array.hpp"
#include "io/scans/whole_source.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kExportAgain = "copy the file again from its source or export it again";
constexpr std::int64_t kMostNumbers = std::int64_t{1} << 50;

/// Reads a file of VTK's XML. It is in memory as a whole.
class VtpReader {
 public:
  VtpReader(ByteSource& source, ScanBuilder& builder)
      : bytes_(read_whole(source)), builder_(builder), arrays_(builder, encoding_) {}

  void read() {
    parse();
    const pugi::xml_node file = document_.child("VTKFile");
    if (!file) fail(document_, "this is not a VTK file: it has no element VTKFile", kExportAgain);
    const std::string kind = file.attribute("type").as_string();
    if (kind != "PolyData")
      fail(file, "a VTK file of the type '" + printable(kind.substr(0, 40)) + "' is not a surface",
           "save its surface as PolyData (in ParaView: Extract Surface) or as .ply");
    read_encoding(file);
    for (const pugi::xml_node piece : file.child("PolyData").children("Piece")) read_piece(piece);
  }

 private:
  [[noreturn]] void fail(pugi::xml_node node, const std::string& problem,
                         const std::string& remedy) const {
    builder_.fail({Place::Unit::kByte, std::max<std::int64_t>(node.offset_debug(), 0)}, problem,
                  remedy);
  }

  /// Parses the XML. Appended data may be raw bytes, which are no XML, so it is taken out before.
  void parse() {
    const std::size_t appended = bytes_.find("<AppendedData");
    if (appended == std::string::npos) {
      xml_ = std::move(bytes_);
    } else {
      const std::size_t end = std::min(bytes_.find('>', appended), bytes_.size());
      const std::size_t begin = std::min(bytes_.find('_', end), bytes_.size() - 1) + 1;
      const std::string_view tag = std::string_view(bytes_).substr(appended, end - appended);
      encoding_.appended = std::string_view(bytes_).substr(begin);
      encoding_.appended_is_base64 = tag.find("base64") != std::string_view::npos;
      xml_ = bytes_.substr(0, appended) + "</VTKFile>";
    }
    const pugi::xml_parse_result result = document_.load_buffer_inplace(xml_.data(), xml_.size());
    if (!result)
      builder_.fail({Place::Unit::kByte, result.offset},
                    std::string("the XML of the file is damaged (") + result.description() + ")",
                    kExportAgain);
  }

  void read_encoding(pugi::xml_node file) {
    const std::string_view order = file.attribute("byte_order").as_string("LittleEndian");
    if (order == "BigEndian") encoding_.order = std::endian::big;
    const std::string_view header = file.attribute("header_type").as_string("UInt32");
    if (header == "UInt64") encoding_.header_bytes = 8;
    if ((order != "BigEndian" && order != "LittleEndian") ||
        (header != "UInt64" && header != "UInt32"))
      fail(file, "its byte_order or header_type is unknown", kExportAgain);
    const std::string compressor = file.attribute("compressor").as_string();
    encoding_.compressed = compressor == "vtkZLibDataCompressor";
    if (!compressor.empty() && !encoding_.compressed)
      fail(file,
           "it is compressed by '" + printable(compressor.substr(0, 40)) +
               "', which is not supported",
           "save it with ZLib or without compression");
  }

  /// Returns a number that a piece promises.
  std::int64_t count(pugi::xml_node piece, const char* name) const {
    const std::int64_t number = piece.attribute(name).as_llong(0);
    if (number < 0 || number > kMostNumbers)
      fail(piece, std::string(name) + " is negative or too large", kExportAgain);
    return number;
  }

  void read_piece(pugi::xml_node piece) {
    const std::int64_t points = count(piece, "NumberOfPoints");
    if (points == 0) return;
    const std::int64_t first = builder_.point_count();
    const pugi::xml_node array = piece.child("Points").child("DataArray");
    if (!array) fail(piece, "the piece has no array of points", kExportAgain);
    if (array.attribute("NumberOfComponents").as_int(3) != 3)
      fail(array, "the points do not have three coordinates", kExportAgain);
    const std::vector<double> xyz = arrays_.numbers(array, 3 * points);
    for (std::size_t i = 0; i < xyz.size(); i += 3)
      builder_.add_point(xyz[i], xyz[i + 1], xyz[i + 2],
                         {Place::Unit::kVertex, builder_.point_count()});
    read_normals(piece.child("PointData"), first, points);
    read_cells(piece, first, "Polys", "NumberOfPolys", add_vtk_polygon);
    read_cells(piece, first, "Strips", "NumberOfStrips", add_vtk_strip);
    read_cells(piece, first, "Lines", "NumberOfLines", add_vtk_part);
    read_cells(piece, first, "Verts", "NumberOfVerts", add_vtk_part);
  }

  /// Reads the normals of points. Normals only help: damaged ones count as none.
  void read_normals(pugi::xml_node data, std::int64_t first, std::int64_t points) try {
    const char* const name = data.attribute("Normals").as_string("Normals");
    const pugi::xml_node array = data.find_child_by_attribute("DataArray", "Name", name);
    if (array.attribute("NumberOfComponents").as_int() != 3) return;
    const std::vector<double> xyz = arrays_.numbers(array, 3 * points);
    for (std::int64_t i = 0; i < points; ++i)
      builder_.add_normal(first + i, Eigen::Vector3d(&xyz[3 * i]).cast<float>());
  } catch (const Error&) {
  }

  using AddCell = void(ScanBuilder&, std::span<const std::int64_t>, std::int64_t);

  /// Reads the cells of an element of the piece. Its points begin at `first`.
  void read_cells(pugi::xml_node piece, std::int64_t first, const char* name,
                  const char* count_name, AddCell* add) {
    const std::int64_t cell_count = count(piece, count_name);
    if (cell_count == 0) return;
    const pugi::xml_node element = piece.child(name);
    VtkCells cells;
    cells.ends = arrays_.integers(find(piece, element, name, "offsets"), cell_count);
    const pugi::xml_node corners = find(piece, element, name, "connectivity");
    cells.corners = arrays_.integers(corners, std::max<std::int64_t>(cells.ends.back(), 0));
    if (cells.first_bad_cell() >= 0)
      fail(element, "the offsets of the cells do not fit their corners", kExportAgain);
    const std::int64_t points = builder_.point_count() - first;
    for (std::int64_t& corner : cells.corners) {
      if (corner < 0 || corner >= points)
        fail(corners,
             "a face refers to point " + std::to_string(corner) + " of " + std::to_string(points) +
                 " in its piece",
             kExportAgain);
      corner += first;
    }
    for (std::int64_t i = 0; i < cell_count; ++i) add(builder_, cells.cell(i), faces_++);
  }

  pugi::xml_node find(pugi::xml_node piece, pugi::xml_node element, const char* name,
                      const char* array) const {
    const pugi::xml_node found = element.find_child_by_attribute("DataArray", "Name", array);
    if (!found)
      fail(piece, std::string("its ") + name + " have no array '" + array + "'", kExportAgain);
    return found;
  }

  std::string bytes_;
  std::string xml_;  // without appended data; its texts are those of the document
  ScanBuilder& builder_;
  VtpEncoding encoding_;
  VtpArrays arrays_;
  pugi::xml_document document_;
  std::int64_t faces_ = 0;
};

Scan read_vtp(ByteSource& source, const ScanOptions& options) {
  ScanBuilder builder(source, options);
  VtpReader(source, builder).read();
  return builder.finish("VTK XML");
}

std::string variant_of(std::string_view) {
  return "VTK XML";
}

}  // namespace

const ScanFormat kVtpFormat = {
    .extension = ".vtp",
    .read = read_vtp,
    .variant = variant_of,
    .content = "meshes, triangle strips",
    .variants = "XML of VTK: ascii, binary or appended arrays, plain or compressed by ZLib"};

}  // namespace semigeo::io
