#include <memory>
#include <string>
#include <vector>

#include "io/files/compression.hpp"
#include "io/files/container.hpp"
#include "io/scans/scan_formats.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/export_level.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Returns a sentence about packed scans, in lines that fit a narrow terminal.
std::string about_packed_scans() {
  std::string text = "Each also compressed: ";
  for (const io::FileCompression& compression : io::kFileCompressions)
    text += std::string(compression.extension) + ", ";
  text.resize(text.size() - 2);
  text += ".\nIn containers, too: ";
  for (const std::string& extension : io::container_extensions()) text += extension + ", ";
  text.resize(text.size() - 2);
  return text + ".\n\n";
}

void print_as_json() {
  nlohmann::json read = nlohmann::json::array();
  for (const io::ScanFormat* format : io::kScanFormats)
    read.push_back({{"extension", format->extension},
                    {"content", format->content},
                    {"variants", format->variants}});
  nlohmann::json written = nlohmann::json::array();
  for (const ExportFormatInfo& format : kExportFormats)
    written.push_back({{"extension", format.extension},
                       {"surfaces", format.surfaces},
                       {"features_and_contours", format.tables},
                       {"content", format.content}});
  nlohmann::json packed = nlohmann::json::array();
  for (const io::FileCompression& compression : io::kFileCompressions)
    packed.push_back(compression.extension);
  print_document({{"read", read},
                  {"compressions", packed},
                  {"containers", io::container_extensions()},
                  {"written", written}});
}

void print_as_text() {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(io::kScanFormats.size());
  for (const io::ScanFormat* format : io::kScanFormats)
    rows.push_back({std::string(format->extension), std::string(format->content),
                    std::string(format->variants)});
  print_text("Scans that are read:\n" + table_text(rows, 2, "lll"));
  print_text(about_packed_scans());
  rows.clear();
  for (const ExportFormatInfo& format : kExportFormats)
    rows.push_back({std::string(format.extension), std::string(format.content)});
  print_text("What `export` writes:\n" + table_text(rows, 2, "ll"));
}

}  // namespace

void add_formats(CLI::App& app, int& exit_code) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("formats", "Say which formats are read and written");
  command->footer(
      "Examples:\n"
      "  semigeo formats          a table\n"
      "  semigeo formats --json   for programs\n");
  command->add_flag("--json", *json, "As JSON");
  command->callback([json, &exit_code] {
    if (*json) {
      print_as_json();
    } else {
      print_as_text();
    }
    exit_code = kAllDone;
  });
}

}  // namespace semigeo::jobs::cli
