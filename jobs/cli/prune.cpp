#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "jobs/archive/archive_lock.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/leftovers_report.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

namespace fs = std::filesystem;

struct PruneOptions {
  fs::path archive;
  std::vector<fs::path> folders;  ///< Empty: the folders of all scans that the archive knows.
  bool dry_run = false;
  bool force = false;
  bool json = false;
};

/// Prints what was or would be removed; `all` is whether that is all there is.
void print_leftovers(const PruneOptions& options, const std::vector<Leftover>& leftovers,
                     bool all) {
  if (options.json) {
    print_document({{options.dry_run ? "would_remove" : "removed", leftovers_json(leftovers)}});
    return;
  }
  const std::string action = options.dry_run ? "would remove" : "removed";
  for (const Leftover& leftover : leftovers)
    print(action, ": ", leftover.files.front(), ": its scan is gone: ", leftover.scan, "\n");
  if (leftovers.empty()) {
    if (all) print("nothing to remove: every scan that the archive knows there is where it was\n");
    return;
  }
  print(action, ": ", counts_in_words(leftovers), "\n");
  if (io::is_there(options.archive / "library.h5"))
    print("The library keeps their models until it is made anew: semigeo library build ",
          options.archive, ", or run --library\n");
}

int prune(const PruneOptions& options) {
  if (!io::is_folder(options.archive)) {
    complain(options.archive, ": is no archive; give the folder that was --output of a run");
    return kUsage;
  }
  std::optional<ArchiveLock> lock;
  Leftovers leftovers;
  try {
    const std::vector<fs::path> recorded = recorded_folders(options.archive);
    if (recorded.empty())
      throw io::Error(options.archive, "", "has no record of scans (sources.json)",
                      "give the folder that was --output of a run");
    if (!options.dry_run) lock.emplace(options.archive);
    leftovers =
        find_leftovers(options.archive, options.folders.empty() ? recorded : options.folders);
  } catch (const LockedError& e) {
    complain(e);
    return kLocked;
  } catch (const io::Error& e) {
    complain(e);
    return kUsage;
  }
  const std::string ask = reason_to_ask(leftovers);
  if (!ask.empty() && !options.force) {
    complain(ask);
    if (!options.dry_run) return kUsage;
  }
  const std::string look_again = reason_to_look_again(leftovers);
  Removal removal;
  if (options.dry_run)
    removal.removed = leftovers.list;
  else
    removal = remove_leftovers(options.archive, leftovers);
  const bool all = removal.failures.empty() && look_again.empty();
  print_leftovers(options, removal.removed, all);
  for (const io::Error& failure : removal.failures) complain(failure);
  if (!look_again.empty()) complain(look_again);
  return all ? kAllDone : kSomeFailed;
}

}  // namespace

void add_prune(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<PruneOptions>();
  CLI::App* command =
      app.add_subcommand("prune", "Remove what an archive still has of scans that are gone");
  command->footer(
      "Examples:\n"
      "  semigeo prune archive --dry-run         what would be removed\n"
      "  semigeo prune archive                   scans gone from the folders that were searched\n"
      "  semigeo prune archive scans/day1        only those that were in or below scans/day1\n"
      "\n"
      "Removes the datasets of scans that are gone, their sidecars, logs and triplets, and what "
      "was\n"
      "recognised in scenes that are gone. If a folder does not exist, or if all scans of a "
      "folder\n"
      "are gone, nothing is removed: its disk may not be mounted. Exit codes: 0 done, 1 something\n"
      "could not be removed or looked for, 2 refused, 73 a run has the archive.\n");
  command->add_option("archive", options->archive, "The archive")->required();
  command
      ->add_option("folders", options->folders,
                   "Folders of scans; without them, all folders whose scans the archive knows")
      ->default_str("");
  command->add_flag("--dry-run", options->dry_run, "Say what would be removed; remove nothing");
  command->add_flag("--force", options->force, "Also if all scans of a folder are gone");
  command->add_flag("--json", options->json, "As JSON");
  command->callback([options, &exit_code] { exit_code = prune(*options); });
}

}  // namespace semigeo::jobs::cli
