#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "jobs/archive/find_scans.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/run/run.hpp"

namespace semigeo::jobs::cli {

/// What `semigeo recognise` and `semigeo similar` search for, where, and how.
struct SearchRun {
  std::vector<std::filesystem::path> inputs;  ///< Scenes, and folders of them.
  ExecutionOptions execution;
  std::string library;
  std::string output;  ///< Folder for the results; empty: they are not kept.
  SearchParameters search;
  std::optional<double> min_score;  ///< Replaces that of `search` if it is given.
};

/// Adds the scenes, the library and the folder for the results to a command. `scenes` names the
/// operands.
void add_search_places(CLI::App& command, const std::string& scenes, SearchRun& run);

/// Checks what the command line has given, and fills in what it has not. Throws
/// CLI::ValidationError if something cannot be.
void complete(SearchRun& run);

/// What was searched, as a report needs it.
struct Searched {
  const SearchedLibrary& library;
  const PassedOver& passed_over;  ///< Files that are no scenes.
  bool has_files;                 ///< The files are kept, so their paths are printed.
};

/// Searches the library for all scenes and prints the results. Returns an exit code.
int run_search(SearchRun& run, const std::function<void(const RunResult&, const Searched&)>& print);

}  // namespace semigeo::jobs::cli
