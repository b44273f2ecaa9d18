#include "jobs/archive/scan_size.hpp"

#include "io/files/container.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::jobs {

ScanSize scan_size(const std::filesystem::path& scan) {
  if (io::member_path(scan)) return {.format = io::likely_scan_variant(scan), .bytes = 0};
  try {
    std::string format = io::scan_variant(scan);
    if (format.empty()) return {};
    return {.format = std::move(format), .bytes = io::bytes_of_scan(scan)};
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace semigeo::jobs
