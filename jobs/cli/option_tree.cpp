#include "jobs/cli/option_tree.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

namespace semigeo::jobs::cli {
namespace {

/// Returns the text between two marks, or an empty string if they are not there.
std::string between(const std::string& text, char first, char last) {
  const std::size_t begin = text.find(first);
  const std::size_t end = text.rfind(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return text.substr(begin + 1, end - begin - 1);
}

void add_commands(const CLI::App& parent, const std::string& prefix,
                  std::vector<ShownCommand>& all) {
  for (const CLI::App* command : commands_of(parent)) {
    const std::string name = prefix + command->get_name();
    all.push_back({name, command, !commands_of(*command).empty()});
    add_commands(*command, name + ' ', all);
  }
}

}  // namespace

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::vector<const CLI::App*> commands_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* own) { return !own->get_group().empty(); });
}

std::vector<ShownCommand> shown_commands(const CLI::App& program) {
  std::vector<ShownCommand> all;
  add_commands(program, "", all);
  return all;
}

std::vector<const CLI::Option*> dashed_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

std::vector<const CLI::Option*> positionals(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() != 0;
}

std::vector<std::string> choices_of(const CLI::Option& option) {
  std::vector<std::string> words;
  std::istringstream list(between(option.get_type_name(), '{', '}'));
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

std::string placeholder(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  const std::string type = option.get_type_name();
  if (const std::string words = between(type, '{', '}'); !words.empty())
    return replaced(words, ",", "|");
  const std::pair<const char*, const char*> names[] = {
      {"SIZE", "SIZE"}, {"DURATION", "TIME"}, {"INT", "N"}, {"FLOAT", "NUMBER"}};
  for (const auto& [part, name] : names)
    if (type.find(part) != std::string::npos) return name;
  return "TEXT";
}

std::string range(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type.find(" in [") == std::string::npos) return "";
  return replaced(between(type, '[', ']'), " - ", " to ");
}

std::string description_of(const CLI::Option& option) {
  return replaced(option.get_description(), "\n", " ");
}

HelpText help_text(const CLI::App& command) {
  HelpText help;
  std::istringstream lines(command.get_footer());
  std::string paragraph;
  const auto end_paragraph = [&] {
    if (!paragraph.empty()) help.paragraphs.push_back(std::exchange(paragraph, ""));
  };
  for (std::string line; std::getline(lines, line);) {
    if (line == "Examples:") continue;
    if (line.starts_with("  ")) {
      help.examples.push_back(line.substr(2));
    } else if (line.empty()) {
      end_paragraph();
    } else {
      paragraph += (paragraph.empty() ? "" : " ") + line;
    }
  }
  end_paragraph();
  return help;
}

}  // namespace semigeo::jobs::cli
