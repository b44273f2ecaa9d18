#pragma once

#include <bit>
#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/scans/scan_builder.hpp"
#include "io/scans/vtk_cells.hpp"

namespace semigeo::io {

/// What holds for all arrays of a file of VTK's XML.
struct VtpEncoding {
  std::endian order = std::endian::little;
  int header_bytes = 4;       ///< Bytes of each number in the header of an array: 4 or 8.
  bool compressed = false;    ///< Binary arrays are compressed by zlib.
  std::string_view appended;  ///< The bytes behind the '_' of AppendedData.
  bool appended_is_base64 = false;
};

/// Reads the numbers of DataArray elements. What is wrong is an Error with the byte of the element.
class VtpArrays {
 public:
  VtpArrays(const ScanBuilder& builder, const VtpEncoding& encoding)
      : builder_(builder), encoding_(encoding) {}

  /// Returns `count` numbers. Throws Error if the array has fewer.
  std::vector<double> numbers(pugi::xml_node array, std::int64_t count) const;
  /// Returns `count` whole numbers, or all that there are if `count` is negative.
  std::vector<std::int64_t> integers(pugi::xml_node array, std::int64_t count) const;

 private:
  template <typename Number>
  std::vector<Number> read(pugi::xml_node array, std::int64_t count) const;
  template <typename Number>
  std::vector<Number> read_ascii(pugi::xml_node array, std::int64_t count) const;
  VtkType type_of(pugi::xml_node array) const;
  /// Returns the bytes of a binary or an appended array, of which up to `most` are needed.
  std::string bytes_of(pugi::xml_node array, std::int64_t most) const;
  [[noreturn]] void fail(pugi::xml_node array, const std::string& problem,
                         const std::string& remedy = {}) const;

  const ScanBuilder& builder_;
  const VtpEncoding& encoding_;
};

}  // namespace semigeo::io
