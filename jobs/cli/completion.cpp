#include "jobs/cli/completion.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "jobs/cli/option_tree.hpp"

namespace semigeo::jobs::cli {
namespace {

/// What a shell offers for the value of an option.
enum class Offer { kWords, kFiles, kNothing };

Offer offer_of(const CLI::Option& option) {
  if (!choices_of(option).empty()) return Offer::kWords;
  return placeholder(option) == "TEXT" ? Offer::kFiles : Offer::kNothing;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> command_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* own : commands_of(command)) names.push_back(own->get_name());
  return names;
}

std::string all_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : dashed_options(command))
    for (const std::string& name : names_of(*option)) names.push_back(name);
  return joined(names, " ");
}

/// Returns a text in single quotes, as the shells take it.
std::string quoted(const std::string& text) {
  return "'" + replaced(text, "'", "'\\''") + "'";
}

/// Returns a case of bash for a command: its options and the words that may follow it.
std::string bash_command(const std::string& name, const CLI::App& command) {
  return "    " + quoted(name) + ") options=" + quoted(all_names(command)) +
         " words=" + quoted(joined(command_names(command), " ")) + " ;;\n";
}

/// Returns cases of bash for the values behind the options of a command.
std::string bash_values(const std::string& name, const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : dashed_options(command)) {
    if (!takes_value(*option)) continue;
    std::vector<std::string> patterns;
    for (const std::string& dashed : names_of(*option))
      patterns.push_back(quoted(name + ":" + dashed));
    const Offer offer = offer_of(*option);
    text += "    " + joined(patterns, "|") + ") ";
    if (offer == Offer::kWords)
      text += "COMPREPLY=($(compgen -W " + quoted(joined(choices_of(*option), " ")) +
              " -- \"$word\")); return ;;\n";
    if (offer == Offer::kFiles) text += "compopt -o default 2>/dev/null; return ;;\n";
    if (offer == Offer::kNothing) text += "return ;;\n";
  }
  return text;
}

/// Returns the letter that an option has behind a single dash, or an empty string.
std::string letter_of(const CLI::Option& option) {
  return option.get_snames().empty() ? "" : option.get_snames().front();
}

/// Returns a text that may stand in the brackets of zsh's _arguments.
std::string zsh_text(std::string text) {
  for (const std::string mark : {"\\", "[", "]", ":"}) text = replaced(text, mark, "\\" + mark);
  return text;
}

/// Returns what an option is for _arguments of zsh, in quotes.
std::string zsh_option(const CLI::Option& option) {
  std::string value;
  if (takes_value(option)) {
    const Offer offer = offer_of(option);
    value = ":" + zsh_text(placeholder(option)) + ":";
    if (offer == Offer::kWords) value += "(" + joined(choices_of(option), " ") + ")";
    if (offer == Offer::kFiles) value += "_files";
  }
  std::string text;
  for (const std::string& name : names_of(option))
    text += " " + quoted("*" + name + (takes_value(option) && name.starts_with("--") ? "=" : "") +
                         "[" + zsh_text(description_of(option)) + "]" + value);
  return text;
}

/// Returns the function of zsh that completes what follows a command.
std::string zsh_function(const std::string& name, const CLI::App& command) {
  const std::vector<const CLI::App*> own = commands_of(command);
  std::string text = name +
                     "() {\n  local curcontext=$curcontext context state state_descr line\n"
                     "  typeset -A opt_args\n  _arguments -C";
  for (const CLI::Option* option : dashed_options(command))
    text += " \\\n   " + zsh_option(*option);
  if (own.empty()) {
    return text + (positionals(command).empty() ? "" : " \\\n    '*:file:_files'") + "\n}\n\n";
  }
  text +=
      " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n  command)\n"
      "    local -a commands=(\n";
  for (const CLI::App* app : own)
    text += "      " + quoted(app->get_name() + ":" + app->get_description()) + "\n";
  text += "    )\n    _describe command commands ;;\n  argument)\n    case $line[1] in\n";
  for (const CLI::App* app : own)
    text += "    " + app->get_name() + ") " + name + "_" + app->get_name() + " ;;\n";
  text += "    esac ;;\n  esac\n}\n\n";
  for (const CLI::App* app : own) text += zsh_function(name + "_" + app->get_name(), *app);
  return text;
}

/// Returns the condition of fish that a command was given and none of its own commands.
std::string fish_condition(const std::string& command, const CLI::App& app) {
  std::string text;
  for (std::size_t at = 0; at < command.size();) {
    const std::size_t end = std::min(command.find(' ', at), command.size());
    text += (text.empty() ? "" : "; and ") +
            ("__fish_seen_subcommand_from " + command.substr(at, end - at));
    at = end + 1;
  }
  const std::vector<std::string> own = command_names(app);
  if (!own.empty())
    text +=
        (text.empty() ? "" : "; and ") + ("not __fish_seen_subcommand_from " + joined(own, " "));
  return text;
}

std::string fish_command(const std::string& name, const CLI::App& command) {
  const std::string begin = "complete -c semigeo -n " + quoted(fish_condition(name, command));
  std::string text;
  for (const CLI::App* own : commands_of(command))
    text += begin + " -f -a " + own->get_name() + " -d " + quoted(own->get_description()) + "\n";
  for (const CLI::Option* option : dashed_options(command)) {
    text += begin;
    if (const std::string letter = letter_of(*option); !letter.empty()) text += " -s " + letter;
    for (const std::string& name_of : option->get_lnames()) text += " -l " + name_of;
    if (takes_value(*option)) {
      const Offer offer = offer_of(*option);
      if (offer == Offer::kWords) text += " -x -a " + quoted(joined(choices_of(*option), " "));
      if (offer == Offer::kFiles) text += " -r -F";
      if (offer == Offer::kNothing) text += " -x";
    }
    text += " -d " + quoted(description_of(*option)) + "\n";
  }
  return text;
}

}  // namespace

std::string bash_completion(const CLI::App& program) {
  const std::vector<ShownCommand> commands = shown_commands(program);
  std::string names = bash_command("", program);
  std::string values = bash_values("", program);
  std::vector<std::string> known;
  for (const ShownCommand& command : commands) {
    names += bash_command(command.name, *command.app);
    values += bash_values(command.name, *command.app);
    known.push_back(quoted(command.name));
  }
  return "# Completion of semigeo for bash. This file was made by the program itself.\n"
         "_semigeo() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local command= options= words= next i\n"
         "  COMPREPLY=()\n"
         "  # bash splits --option=value at the sign.\n"
         "  if [[ $word == = ]]; then\n"
         "    word=\n"
         "  elif [[ $before == = ]]; then\n"
         "    before=${COMP_WORDS[COMP_CWORD - 2]}\n"
         "  fi\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    next=${command:+$command }${COMP_WORDS[i]}\n"
         "    case $next in\n"
         "    " +
         joined(known, "|") +
         ") command=$next ;;\n"
         "    esac\n"
         "  done\n"
         "  case $command in\n" +
         names +
         "  esac\n"
         "  case $command:$before in\n" +
         values +
         "  esac\n"
         "  if [[ $word == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  elif [[ $words ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "  else\n"
         "    compopt -o default 2>/dev/null\n"
         "  fi\n"
         "}\n"
         "complete -F _semigeo semigeo\n";
}

std::string zsh_completion(const CLI::App& program) {
  return "#compdef semigeo\n# Completion of semigeo for zsh. This file was made by the program "
         "itself.\n\n" +
         zsh_function("_semigeo", program) + "_semigeo \"$@\"\n";
}

std::string fish_completion(const CLI::App& program) {
  std::string text =
      "# Completion of semigeo for fish. This file was made by the program itself.\n" +
      fish_command("", program);
  for (const ShownCommand& command : shown_commands(program))
    text += fish_command(command.name, *command.app);
  return text;
}

}  // namespace semigeo::jobs::cli
