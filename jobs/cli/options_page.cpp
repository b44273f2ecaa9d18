#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include "jobs/cli/command.hpp"
#include "jobs/cli/execution_options.hpp"
#include "jobs/cli/option_tree.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs::cli {
namespace {

constexpr std::size_t kLineWidth = 120;

/// The keys of options in JSON, by their names with dashes; empty for options without a key.
using Keys = std::map<std::string, std::string>;

/// Returns the keys of the options of a table.
template <typename Owner>
Keys keys_by_option(const ParameterTable<Owner>& table) {
  Keys keys;
  for (const Parameter<Owner>& row : table) keys[std::string("--") + row.name] = row.key;
  return keys;
}

/// Prints words, `indent` columns from the left, in lines of at most kLineWidth columns.
void print_paragraph(const std::string& text, std::size_t indent) {
  std::string line(indent, ' ');
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
    const std::string word = text.substr(at, end - at);
    if (line.size() > indent && line.size() + 1 + word.size() > kLineWidth) {
      std::printf("%s\n", line.c_str());
      line.assign(indent, ' ');
    }
    if (line.size() > indent) line += ' ';
    line += word;
    at = end + 1;
  }
  std::printf("%s\n", line.c_str());
}

/// Prints an option as an item of a list. `key` is its key in datasets, or empty.
void print_option(const CLI::Option& option, const std::string& key) {
  std::string head = option.get_positional() ? option.get_name(true) : option.get_name(false, true);
  head = replaced(head, ",", ", ");
  if (const std::string what = placeholder(option); !what.empty() && !option.get_positional())
    head += ' ' + what;
  std::string line = "- `" + head + '`';
  if (const std::string bounds = range(option); !bounds.empty()) line += "; " + bounds;
  if (option.get_required()) line += "; required";
  if (!option.get_default_str().empty()) line += "; default `" + option.get_default_str() + '`';
  if (!key.empty()) line += "; in datasets `" + key + '`';
  std::printf("%s:\n", line.c_str());
  print_paragraph(option.get_description(), 2);
}

/// Prints the options of a command that a table has, in their order.
void print_table(const CLI::App& command, const Keys& keys) {
  for (const CLI::Option* option : command.get_options())
    if (const auto at = keys.find(option->get_name()); at != keys.end())
      print_option(*option, at->second);
}

/// Prints a section for a command, with its options that are in no table.
void print_command(const CLI::App& command, const std::string& name, const Keys& surface,
                   const Keys& execution) {
  const bool makes_datasets = command.get_option_no_throw("--fill-holes") != nullptr;
  const bool runs_jobs = command.get_option_no_throw("--executor") != nullptr;
  std::printf("\n## semigeo %s\n", name.c_str());
  if (makes_datasets) std::printf("The options [of datasets](#datasets), [of jobs](#jobs), and:\n");
  if (runs_jobs && !makes_datasets) std::printf("The options [of jobs](#jobs), and:\n");
  std::printf("\n");
  for (const CLI::Option* option : command.get_options()) {
    const std::string option_name = option->get_name();
    if (option == command.get_help_ptr() || (makes_datasets && surface.contains(option_name)) ||
        (runs_jobs && execution.contains(option_name)))
      continue;
    print_option(*option, "");
  }
}

/// Prints a row of a list: a name, and what it means.
void print_meaning(const std::string& name, std::string_view meaning) {
  std::printf("- `%s`:\n", name.c_str());
  print_paragraph(std::string(meaning), 2);
}

/// Prints what concerns every command.
void print_conventions() {
  std::printf("\n## Exit codes\n");
  for (const ExitCode& exit : kExitCodes) print_meaning(std::to_string(exit.code), exit.meaning);
  std::printf("\n## Environment\n");
  for (const EnvironmentVariable& variable : kEnvironment)
    print_meaning(std::string(variable.name), variable.meaning);
}

/// Prints docs/options.md.
void print_page(const CLI::App& app) {
  const Keys surface = keys_by_option(surface_parameter_table());
  const Keys execution = keys_by_option(execution_option_table());
  const CLI::App& run = *app.get_subcommand("run");
  std::printf(
      "# Options\n"
      "This page is made by `semigeo options`; a test compares the two. `semigeo COMMAND --help` "
      "says the same.\n\n"
      "- `--config FILE`, before or behind the command, reads options from a\n"
      "  [configuration file](usage.md#configuration-file), under their names without dashes.\n"
      "- `SIZE` is a number of bytes, or a number with a unit: `512M`, `8G`. 1 kB is 1024 bytes.\n"
      "- `TIME` is a number of seconds, or a number with a unit: `30s`, `10min`, `8h`, `2d`.\n\n"
      "## Datasets\n"
      "Options of `run`. A dataset depends on them and on its scan, on nothing else. The attribute "
      "`parameters` of a\n"
      "dataset has them under the key that stands behind \"in datasets\".\n\n");
  print_table(run, surface);
  std::printf(
      "\n## Jobs\n"
      "Options of every command that runs jobs. No byte of a result depends on them.\n\n");
  print_table(run, execution);
  for (const ShownCommand& command : shown_commands(app))
    if (!command.has_commands) print_command(*command.app, command.name, surface, execution);
  print_conventions();
}

}  // namespace

void add_options_page(CLI::App& app) {
  app.add_subcommand("options", "Print docs/options.md: all options of all commands")
      ->group("")
      ->callback([&app] { print_page(app); });
}

}  // namespace semigeo::jobs::cli
