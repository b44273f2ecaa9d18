#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/byte_source.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::io {

/// Describes one format of scans.
struct ScanFormat {
  std::string_view extension;  ///< ".ply": the end of its files' names, in lower case.
  /// Reads a source at its start that holds at least one byte, and leaves it anywhere. Throws what
  /// read_scan throws.
  Scan (*read)(ByteSource& source, const ScanOptions& options);
  /// Returns the variant of the format that the first bytes of a file show: "PLY ascii". Files of
  /// one variant need about the same time and memory for each byte.
  std::string (*variant)(std::string_view begin);
  std::string_view content;   ///< What is read, for people: "meshes, range grids".
  std::string_view variants;  ///< Which variants are read, for people; empty if there is one.
  /// Returns how a source at its start names the files beside it that it needs (companions.hpp), or
  /// is nullptr if no file of the format needs another. A damaged source may name none.
  std::vector<std::string> (*companions)(ByteSource& source) = nullptr;
};

// Each is defined by its reader.
extern const ScanFormat kPlyFormat;
extern const ScanFormat kObjFormat;
extern const ScanFormat kOffFormat;
extern const ScanFormat kStlFormat;
extern const ScanFormat kPcdFormat;
extern const ScanFormat kPtxFormat;
extern const ScanFormat kGltfFormat;
extern const ScanFormat kGlbFormat;
extern const ScanFormat kVtkFormat;
extern const ScanFormat kVtpFormat;

/// The formats that the program reads, in the order in which messages name them.
inline constexpr std::array kScanFormats = {&kPlyFormat, &kObjFormat, &kOffFormat,  &kStlFormat,
                                            &kPcdFormat, &kPtxFormat, &kGltfFormat, &kGlbFormat,
                                            &kVtkFormat, &kVtpFormat};

/// Returns the format that a file's name tells, also before the extension of a compression, or
/// nullptr.
const ScanFormat* scan_format_of(const std::filesystem::path& path);

}  // namespace semigeo::io
