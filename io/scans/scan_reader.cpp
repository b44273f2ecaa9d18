#include "io/scans/scan_reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "io/files/byte_source.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_formats.hpp"

namespace semigeo::io {
namespace {

struct FormatEntry {
  std::string_view extension;
  ScanFormat format;
  Scan (*read)(ByteSource&, const ScanLimits&);
};

constexpr std::array<FormatEntry, 4> kFormats = {{{".ply", ScanFormat::kPly, read_ply},
                                                  {".obj", ScanFormat::kObj, read_obj},
                                                  {".off", ScanFormat::kOff, read_off},
                                                  {".stl", ScanFormat::kStl, read_stl}}};

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

const FormatEntry* find_format(const std::filesystem::path& path) {
  std::string extension = lower_case_extension(path);
  if (extension == ".gz") extension = lower_case_extension(path.stem());
  const auto* const entry =
      std::find_if(kFormats.begin(), kFormats.end(),
                   [&](const FormatEntry& candidate) { return candidate.extension == extension; });
  return entry == kFormats.end() ? nullptr : entry;
}

}  // namespace

std::optional<ScanFormat> scan_format(const std::filesystem::path& path) {
  const FormatEntry* entry = find_format(path);
  return entry ? std::optional(entry->format) : std::nullopt;
}

Scan read_scan(const std::filesystem::path& path, const ScanLimits& limits) {
  ByteSource source(path);
  const FormatEntry* entry = find_format(path);
  if (!entry)
    throw Error(path, "", "its name is not that of a scan",
                "scans are .ply, .obj, .off and .stl, and the same with .gz");
  if (!source.fill(1)) throw Error(path, "", "the file is empty", "copy it again from its source");
  try {
    Scan scan = entry->read(source, limits);
    scan.bytes_after_end = source.drain();
    if (source.compressed()) scan.format += ", gzip";
    return scan;
  } catch (const Error&) {
    source.drain();  // throws if the gzip data is damaged, which then is the better explanation
    throw;
  }
}

}  // namespace semigeo::io
