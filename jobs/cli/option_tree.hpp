#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace semigeo::jobs::cli {

// The commands and options of the program, for pages, man pages and completions that are made of
// them.

/// A command that help shows.
struct ShownCommand {
  std::string name;           ///< With the commands above it: "library build".
  const CLI::App* app;        ///< Its options.
  bool has_commands = false;  ///< It does nothing itself: one of its commands must follow.
};

/// Returns all commands that are not hidden, each before its own commands.
std::vector<ShownCommand> shown_commands(const CLI::App& program);

/// Returns the names of a command's own commands that are not hidden.
std::vector<const CLI::App*> commands_of(const CLI::App& command);

/// Returns the options of a command that begin with a dash, --help and --config among them.
std::vector<const CLI::Option*> dashed_options(const CLI::App& command);
/// Returns the arguments of a command that have no dash.
std::vector<const CLI::Option*> positionals(const CLI::App& command);

/// Returns the names of an option with their dashes, short ones first.
std::vector<std::string> names_of(const CLI::Option& option);

/// Returns whether a value stands behind the option.
bool takes_value(const CLI::Option& option);
/// Returns the words that the value may be; empty if it is no choice.
std::vector<std::string> choices_of(const CLI::Option& option);
/// Returns what stands behind the option: "curved|flat", "N", "SIZE"; empty for a flag.
std::string placeholder(const CLI::Option& option);
/// Returns the bounds of a number, "0 to 999", or an empty string.
std::string range(const CLI::Option& option);
/// Returns the description of an option in one line.
std::string description_of(const CLI::Option& option);

/// The text that stands in front of a command's help.
struct HelpText {
  std::vector<std::string> examples;    ///< Lines without their indent.
  std::vector<std::string> paragraphs;  ///< What stands behind them, each in one line.
};
HelpText help_text(const CLI::App& command);

/// Returns `text` with all occurrences of `from` replaced.
std::string replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace semigeo::jobs::cli
