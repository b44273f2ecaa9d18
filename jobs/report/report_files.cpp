#include "jobs/report/report_files.hpp"

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/input_file.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;

static constexpr std::string_view kBeforeKey = "<!-- semigeo ";
static constexpr std::string_view kBehindKey = " -->\n";
static constexpr std::size_t kKeySize = 32;

bool makes_page(std::string_view job) {
  const std::string_view kind = job.substr(0, job.find(' '));
  return kind == kPageKind || kind == kScenePageKind || kind == kReportKind;
}

fs::path scan_page_path(const fs::path& folder, const std::string& name) {
  return folder / "scans" / (name + ".html");
}

fs::path scene_page_path(const fs::path& folder, const std::string& name) {
  return folder / "scenes" / (name + ".html");
}

fs::path index_path(const fs::path& folder) {
  return folder / "index.html";
}

std::string page_key(std::string_view version, const PageTemplate& page, std::string_view content) {
  std::string all(version);
  for (const std::string_view part : {page.before, page.behind, content})
    all.append("\n").append(part);
  return io::xxh3_of_text(all);
}

std::string read_page_key(const fs::path& path) {
  std::string line(kBeforeKey.size() + kKeySize + kBehindKey.size(), '\0');
  const io::InputFile file(path);
  line.resize(file.read_at(0, line));
  if (!line.starts_with(kBeforeKey) || !line.ends_with(kBehindKey))
    throw io::Error(path, "", "is no page of a report", "remove it, and make the report again");
  return line.substr(kBeforeKey.size(), kKeySize);
}

void write_page(const fs::path& path, const std::string& key, std::string_view text) {
  std::string page(kBeforeKey);
  page.append(key).append(kBehindKey).append(text);
  io::write_file_atomically(path, page);
}

}  // namespace semigeo::jobs
