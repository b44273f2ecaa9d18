#include "jobs/cli/manual.hpp"

#include <algorithm>

#include "jobs/cli/conventions.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Returns a text so that roff prints it as it is.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  // At the beginning of a line, a dot or an apostrophe would be a request.
  if (!result.empty() && (result[0] == '.' || result[0] == '\'')) result.insert(0, "\\&");
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string page_head(const std::string& name, const std::string& about) {
  std::string title = name;
  std::ranges::transform(title, title.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return ".\\\" This page was made by the program itself.\n"
         ".TH " +
         plain(title) + " 1 \"\" \"semigeo " SEMIGEO_VERSION "\" \"semigeo\"\n.SH NAME\n" +
         plain(name) + " \\- " + plain(about) + "\n";
}

/// Returns an item of a list: a head, and the text below it.
std::string item(const std::string& head, const std::string& text) {
  return ".TP\n" + head + "\n" + text + "\n";
}

std::string option_item(const CLI::Option& option) {
  std::string head;
  if (option.get_positional()) {
    head = italic(option.get_name(true));
  } else {
    for (const std::string& name : names_of(option))
      head += (head.empty() ? "" : ", ") + bold(name);
    if (const std::string value = placeholder(option); !value.empty())
      head += " " + (choices_of(option).empty() ? italic(value) : plain(value));
  }
  std::string text = plain(description_of(option));
  std::string notes;
  const auto note = [&notes](const std::string& words) {
    notes += (notes.empty() ? "" : "; ") + words;
  };
  if (const std::string bounds = range(option); !bounds.empty()) note(plain(bounds));
  if (option.get_required()) note("required");
  if (takes_value(option) && !option.get_default_str().empty())
    note("default " + bold(option.get_default_str()));
  if (!notes.empty()) text += " (" + notes + ")";
  return item(head, text);
}

std::string examples(const HelpText& help) {
  if (help.examples.empty()) return "";
  std::string text = ".SH EXAMPLES\n.nf\n";
  for (const std::string& line : help.examples) text += plain(line) + "\n";
  return text + ".fi\n";
}

std::string paragraphs(const HelpText& help) {
  std::string text;
  for (const std::string& paragraph : help.paragraphs) text += ".PP\n" + plain(paragraph) + "\n";
  return text;
}

std::string option_items(const std::vector<const CLI::Option*>& options) {
  std::string text;
  for (const CLI::Option* option : options) text += option_item(*option);
  return text;
}

std::string exit_codes() {
  std::string text = ".SH EXIT STATUS\n";
  for (const ExitCode& exit : kExitCodes)
    text += item(bold(std::to_string(exit.code)), plain(exit.meaning));
  return text;
}

std::string environment() {
  std::string text = ".SH ENVIRONMENT\n";
  for (const EnvironmentVariable& variable : kEnvironment)
    text += item(bold(std::string(variable.name)), plain(variable.meaning));
  return text;
}

}  // namespace

std::string manual_name(const ShownCommand& command) {
  return "semigeo-" + replaced(command.name, " ", "-");
}

std::string program_manual(const CLI::App& program) {
  std::string text = page_head("semigeo", "multi-scale surface datasets of archives of 3-D scans");
  text += ".SH SYNOPSIS\n" + bold("semigeo") + " " + italic("COMMAND") + " [" + italic("OPTION") +
          "]... [" + italic("ARGUMENT") + "]...\n";
  text += ".SH DESCRIPTION\n" + plain(program.get_description()) +
          " Results go to standard output, progress and errors to standard error.\n";
  text += ".SH COMMANDS\n";
  for (const ShownCommand& command : shown_commands(program))
    if (!command.has_commands)
      text += item(bold(command.name), plain(command.app->get_description()));
  text += ".SH OPTIONS\n" + option_items(dashed_options(program));
  text += exit_codes() + environment() + examples(help_text(program));
  text += ".SH SEE ALSO\n";
  std::string pages;
  for (const ShownCommand& command : shown_commands(program))
    if (!command.has_commands)
      pages += (pages.empty() ? "" : ",\n") + bold(manual_name(command)) + "(1)";
  return text + pages + "\n";
}

std::string command_manual(const ShownCommand& command) {
  const HelpText help = help_text(*command.app);
  std::string text = page_head(manual_name(command), command.app->get_description());
  text += ".SH SYNOPSIS\n" + bold("semigeo " + command.name) + " [" + italic("OPTION") + "]...";
  for (const CLI::Option* argument : positionals(*command.app)) {
    const std::string name =
        italic(argument->get_name(true)) + (argument->get_items_expected_max() > 1 ? "..." : "");
    text += argument->get_required() ? " " + name : " [" + name + "]";
  }
  text += "\n.SH DESCRIPTION\n" + plain(command.app->get_description()) + ".\n" + paragraphs(help);
  if (!positionals(*command.app).empty())
    text += ".SH ARGUMENTS\n" + option_items(positionals(*command.app));
  text += ".SH OPTIONS\n" + option_items(dashed_options(*command.app));
  text += exit_codes() + examples(help);
  return text + ".SH SEE ALSO\n" + bold("semigeo") + "(1)\n";
}

}  // namespace semigeo::jobs::cli
