#include "jobs/archive/scan_size.hpp"

#include <string_view>

#include "io/files/byte_source.hpp"
#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLookedAt = 1024;

bool has(std::string_view begin, std::string_view word) {
  return begin.find(word) != std::string_view::npos;
}

std::string format_of(io::ScanFormat format, std::string_view begin) {
  switch (format) {
    case io::ScanFormat::kPly:
      return has(begin, "format ascii") ? "PLY ascii" : "PLY binary";
    case io::ScanFormat::kObj:
      return "OBJ";
    case io::ScanFormat::kOff:
      return has(begin.substr(0, begin.find('\n')), "BINARY") ? "OFF binary" : "OFF";
    case io::ScanFormat::kStl:
      break;
  }
  // The header of a binary file may begin with the same word, but its numbers hold zeros.
  return begin.starts_with("solid") && !has(begin, std::string_view("\0", 1)) ? "STL ascii"
                                                                              : "STL binary";
}

}  // namespace

ScanSize scan_size(const fs::path& scan) {
  const auto format = io::scan_format(scan);
  if (!format) return {};
  try {
    io::ByteSource source(scan);
    source.fill(kLookedAt);
    std::string name = format_of(*format, source.ahead().substr(0, kLookedAt));
    if (source.compressed()) name += ", gzip";
    return {.format = std::move(name), .bytes = fs::file_size(scan)};
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace semigeo::jobs
