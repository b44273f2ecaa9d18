#include <memory>
#include <nlohmann/json.hpp>

#include "io/files/atomic_file.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/report/archive_report.hpp"
#include "jobs/report/page.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  fs::path archive;
  fs::path folder;  ///< Empty: ARCHIVE/report.
  bool json = false;
};

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
  const fs::path index = folder / "index.html";
  io::write_file_atomically(index, page_with(pages().index, document));
  const std::size_t scans = document["scans"].size();
  const std::size_t failures = document["failures"].size();
  if (options.json)
    print_document({{"report", index.string()}, {"scans", scans}, {"failures", failures}});
  else
    print(index, ": ", scans, " scans, ", failures, " failures\n");
  return kAllDone;
}

}  // namespace

void add_report(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Make a page for a browser of what an archive holds");
  command->footer(
      "Examples:\n"
      "  semigeo report archive                  archive/report/index.html\n"
      "  semigeo report archive --output page    page/index.html\n"
      "\n"
      "The page opens by double click, needs no network and can be mailed. Exit codes: 0 done,\n"
      "1 the archive cannot be read or the page cannot be written, 2 this program was built\n"
      "without the report.\n");
  command->add_option("archive", options->archive, "The archive")->required();
  command
      ->add_option("-o,--output", options->folder, "Folder of the page; without it, ARCHIVE/report")
      ->default_str("");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = report(*options); });
}

}  // namespace semigeo::jobs::cli
