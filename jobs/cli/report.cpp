#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "io/dataset/dataset.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/report/archive_report.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/scan_page.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  fs::path archive;
  fs::path folder;  ///< Empty: ARCHIVE/report.
  bool index_only = false;
  bool json = false;
};

/// What became of the pages of scans.
struct ScanPages {
  std::size_t made = 0;
  std::size_t up_to_date = 0;
  std::size_t failed = 0;
};

/// Makes the pages of all scans that have a dataset, and links them from the document of the index.
ScanPages make_scan_pages(const ReportOptions& options, const fs::path& folder,
                          nlohmann::json& document) {
  ScanPages pages_of_scans;
  fs::create_directories(folder / "scans");
  for (nlohmann::json& scan : document["scans"]) {
    if (!scan.contains("vertices")) continue;  // no dataset that can be read
    const auto name = scan["name"].get<std::string>();
    const std::string page = "scans/" + name + ".html";
    try {
      const io::Dataset dataset(options.archive / "scans" / (name + ".vtkhdf"));
      const bool made = make_scan_page(dataset, pages().scan, folder / page);
      ++(made ? pages_of_scans.made : pages_of_scans.up_to_date);
      scan["page"] = page;
    } catch (const io::Error& e) {
      complain(e);
      ++pages_of_scans.failed;
    }
  }
  return pages_of_scans;
}

int report(const ReportOptions& options) {
  if (!pages().missing.empty()) {
    complain("this program has no report: ", pages().missing,
             "; install node and npm, and build it again (CONTRIBUTING.md)");
    return kUsage;
  }
  nlohmann::json document = archive_report(options.archive);
  document["version"] = SEMIGEO_VERSION;
  const fs::path folder = options.folder.empty() ? options.archive / "report" : options.folder;
  fs::create_directories(folder);
  ScanPages scan_pages;
  if (!options.index_only) scan_pages = make_scan_pages(options, folder, document);
  const fs::path index = folder / "index.html";
  io::write_file_atomically(index, page_with(pages().index, document));
  const std::size_t scans = document["scans"].size();
  const std::size_t failures = document["failures"].size();
  if (options.json)
    print_document({{"report", index.string()},
                    {"scans", scans},
                    {"failures", failures},
                    {"pages_made", scan_pages.made},
                    {"pages_up_to_date", scan_pages.up_to_date},
                    {"pages_failed", scan_pages.failed}});
  else
    print(index, "\nscans: ", scans, ", failures: ", failures,
          "; pages of scans: ", scan_pages.made, " made, ", scan_pages.up_to_date, " up to date\n");
  return scan_pages.failed > 0 ? kSomeFailed : kAllDone;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Make pages for a browser of what an archive holds");
  command->footer(
      "Examples:\n"
      "  semigeo report archive                  archive/report/index.html, a page for each scan\n"
      "  semigeo report archive --output pages   pages/index.html, pages/scans/*.html\n"
      "  semigeo report archive --index-only     the table of all scans alone\n"
      "\n"
      "The pages open by double click, need no network and can be mailed. A page of a scan takes\n"
      "up to 6 MB; one that shows what the dataset holds is left as it is. Exit codes: 0 done,\n"
      "1 something cannot be read or written, 2 this program was built without the report.\n");
  command->add_option("archive", options->archive, "The archive")->required();
  command
      ->add_option("-o,--output", options->folder,
                   "Folder of the pages; without it, ARCHIVE/report")
      ->default_str("");
  command->add_flag("--index-only", options->index_only, "Make no pages of single scans");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = report(*options); });
}

}  // namespace semigeo::jobs::cli
