#pragma once

#include <zlib.h>

#include <bit>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/io/scans/gltf_files.hpp"

/// Files of VTK that are made by hand.
namespace semigeo::io {

/// Writes the numbers of a file of the legacy format: as text, or as big-endian bytes.
struct VtkText {
  bool binary = false;
  std::string text;

  explicit VtkText(bool is_binary, const std::string& version = "4.2") : binary(is_binary) {
    text = "# vtk DataFile Version " + version + "\nPOINTS 3 of a title\n" +
           (binary ? "BINARY" : "ASCII") + "\n";
  }
  VtkText& line(const std::string& words) {
    text += words + "\n";
    return *this;
  }
  template <typename Number>
  VtkText& numbers(const std::vector<Number>& values) {
    if (binary) {
      text += bytes_of_all(values, std::endian::big);
    } else {
      for (const Number value : values) text += std::to_string(value) + " ";
    }
    text += "\n";
    return *this;
  }
};

/// Returns zlib data.
inline std::string zlib(std::string_view plain) {
  uLongf size = compressBound(static_cast<uLong>(plain.size()));
  std::string packed(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &size,
               reinterpret_cast<const Bytef*>(plain.data()),
               static_cast<uLong>(plain.size())) != Z_OK)
    throw std::runtime_error("compress");
  packed.resize(size);
  return packed;
}

/// Writes files of VTK's XML in every way that arrays are stored.
struct VtpWriter {
  std::string format = "ascii";  ///< Of arrays: ascii, binary or appended.
  std::string encoding = "raw";  ///< Of appended arrays: raw or base64.
  std::endian order = std::endian::little;
  bool wide_header = false;
  bool compressed = false;
  std::string appended = {};

  template <typename Number>
  std::string array(const std::string& name, const std::string& type,
                    const std::vector<Number>& numbers, int components = 1) {
    std::string element = "<DataArray type=\"" + type + "\" Name=\"" + name +
                          "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"" +
                          format + "\"";
    if (format == "ascii") {
      element += ">\n";
      for (const Number number : numbers) element += std::to_string(number) + " ";
    } else if (format == "binary") {
      element += ">\n" + encoded(bytes_of_all(numbers, order), true);
    } else {
      element += " offset=\"" + std::to_string(appended.size()) + "\">";
      appended += encoded(bytes_of_all(numbers, order), encoding == "base64");
    }
    return element + "\n</DataArray>";
  }

  /// Returns a file of pieces.
  std::string file(const std::string& pieces) const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\"";
    text += std::string(" byte_order=\"") +
            (order == std::endian::little ? "LittleEndian" : "BigEndian") + "\" header_type=\"" +
            (wide_header ? "UInt64" : "UInt32") + "\"";
    if (compressed) text += " compressor=\"vtkZLibDataCompressor\"";
    text += ">\n<PolyData>" + pieces + "</PolyData>\n";
    if (format == "appended")
      text += "<AppendedData encoding=\"" + encoding + "\">\n_" + appended + "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
  }

  /// Returns a piece of four points, a triangle, a strip of two triangles, and a line.
  std::string piece() {
    const std::string points = array("Points", "Float32", kSquare, 3);
    const auto cells = [&](const std::string& name, const std::vector<std::int64_t>& corners) {
      const std::string connectivity = array("connectivity", "Int64", corners);
      const std::vector<std::int32_t> ends = {static_cast<std::int32_t>(corners.size())};
      return "<" + name + ">" + connectivity + array("offsets", "Int32", ends) + "</" + name + ">";
    };
    return "<Piece NumberOfPoints=\"4\" NumberOfPolys=\"1\" NumberOfStrips=\"1\" "
           "NumberOfLines=\"1\"><Points>" +
           points + "</Points>" + cells("Polys", {0, 1, 2}) + cells("Strips", {0, 1, 3, 2}) +
           cells("Lines", {0, 1}) + "</Piece>";
  }

 private:
  std::string number(std::size_t value) const {
    return wide_header ? bytes_of(static_cast<std::uint64_t>(value), order)
                       : bytes_of(static_cast<std::uint32_t>(value), order);
  }
  std::string encoded(const std::string& bytes, bool as_base64) const {
    std::string header = number(bytes.size()), data = bytes;
    if (compressed) {
      constexpr std::size_t kBlock = 16;
      const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
      header = number(blocks) + number(kBlock) + number(bytes.size() % kBlock);
      data = "";
      for (std::size_t i = 0; i < blocks; ++i) {
        const std::string packed = zlib(std::string_view(bytes).substr(i * kBlock, kBlock));
        header += number(packed.size());
        data += packed;
      }
      // A compressed array has its header encoded apart.
      return as_base64 ? base64(header) + base64(data) : header + data;
    }
    return as_base64 ? base64(header + data) : header + data;
  }
};

}  // namespace semigeo::io
