// A scan of the format whose extension is SEMIGEO_FUZZ_EXTENSION.
#include <cmath>

#include "io/files/error.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/scan_formats.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

constexpr const char* kName = "scan" SEMIGEO_FUZZ_EXTENSION;

void check_mesh(const io::Scan& scan) {
  check(!scan.mesh.points.empty() && !scan.mesh.triangles.empty(), "a scan is empty");
  for (const Eigen::Vector3d& point : scan.mesh.points)
    check(point.allFinite(), "a point is not finite");
  const auto count = static_cast<std::int64_t>(scan.mesh.points.size());
  for (const auto& triangle : scan.mesh.triangles)
    for (const std::int64_t corner : triangle)
      check(corner >= 0 && corner < count, "a corner does not exist");
  check(scan.mesh.normals.size() <= scan.mesh.points.size(), "a normal has no point");
}

}  // namespace

void read_input(std::string_view bytes) {
  // Formats whose files need others find one.
  static const std::filesystem::path beside = write("beside.bin", std::string(62, '\1'));
  const std::filesystem::path path = write(kName, bytes);
  check(!io::scan_format_of(path)->variant(bytes.substr(0, 1024)).empty(), "there is no variant");
  try {
    if (io::may_have_companions(path)) io::bytes_of_scan(path);
    check_mesh(io::read_scan(path));
  } catch (const io::Error& error) {
    check(error.file() == path, "an error names another file");
    check(!error.problem().empty(), "an error says nothing");
  }
}

}  // namespace semigeo::fuzz
