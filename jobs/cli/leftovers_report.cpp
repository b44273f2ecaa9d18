#include "jobs/cli/leftovers_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/files/number_text.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {

namespace fs = std::filesystem;

std::string counts_in_words(const std::vector<Leftover>& leftovers) {
  const auto datasets = std::ranges::count(leftovers, Leftover::Kind::kDataset, &Leftover::kind);
  const auto recognised = std::ssize(leftovers) - datasets;
  double bytes = 0;
  for (const Leftover& leftover : leftovers) bytes += static_cast<double>(leftover.bytes);
  std::string text;
  if (datasets > 0) text = counted(datasets, "dataset");
  if (datasets > 0 && recognised > 0) text += " and ";
  if (recognised > 0) text += counted(recognised, "recognised file");
  return text + (leftovers.size() == 1 ? " of a scan that is gone" : " of scans that are gone") +
         " (" + io::fixed_text(bytes / 1e6, bytes < 1e7 ? 1 : 0) + " MB)";
}

nlohmann::json leftovers_json(const std::vector<Leftover>& leftovers) {
  nlohmann::json list = nlohmann::json::array();
  for (const Leftover& leftover : leftovers) {
    nlohmann::json files = nlohmann::json::array();
    for (const fs::path& file : leftover.files) files.push_back(file.string());
    list.push_back({{"kind", leftover.kind == Leftover::Kind::kDataset ? "dataset" : "recognised"},
                    {"name", leftover.name},
                    {"scan", leftover.scan.string()},
                    {"files", std::move(files)},
                    {"bytes", leftover.bytes}});
  }
  return list;
}

std::string reason_to_ask(const Leftovers& leftovers) {
  if (leftovers.emptied.empty()) return "";
  const std::size_t more = leftovers.emptied.size() - 1;
  return leftovers.emptied.front().string() +
         (more == 0 ? "" : " and " + counted(more, "other folder")) +
         ": all scans that were recorded there are gone, so nothing is removed; see that the disk "
         "is mounted, or give --force if they are gone for good";
}

std::string reason_to_look_again(const Leftovers& leftovers) {
  if (leftovers.unknown.empty()) return "";
  return std::string(leftovers.unknown.front().what()) + ": whether " +
         (leftovers.unknown.size() == 1
              ? "this scan is"
              : "this and " + counted(std::ssize(leftovers.unknown) - 1, "other scan") + " are") +
         " gone is not known, so what is of them stays";
}

std::string prune_command(const fs::path& archive, const std::vector<fs::path>& folders) {
  std::string text = "semigeo prune " + shell_word(archive.string());
  for (const fs::path& folder : folders) text += ' ' + shell_word(folder.string());
  return text;
}

}  // namespace semigeo::jobs::cli
