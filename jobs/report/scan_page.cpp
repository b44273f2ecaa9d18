#include "jobs/report/scan_page.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/files/file_digest.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/scan_report.hpp"

namespace semigeo::jobs {
namespace {

/// Returns the comment that is the first line of a page. The file name of the dataset is in the
/// page, too.
std::string first_line_of(const io::Dataset& dataset, const PageTemplate& page) {
  std::string all(kScanPageVersion);
  for (const std::string_view part : {std::string_view(dataset.digest()), page.before, page.behind})
    all.append("\n").append(part);
  return "<!-- semigeo " + io::xxh3_of_text(all + "\n" + dataset.path().filename().string()) +
         " -->";
}

}  // namespace

bool make_scan_page(const io::Dataset& dataset, const PageTemplate& page,
                    const std::filesystem::path& path) {
  const std::string first = first_line_of(dataset, page);
  std::string found;
  std::ifstream present(path, std::ios::binary);
  std::getline(present, found);
  if (found == first) return false;
  io::write_file_atomically(path, first + "\n" + page_with(page, scan_report(dataset)));
  return true;
}

}  // namespace semigeo::jobs
