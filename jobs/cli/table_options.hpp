#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <string>
#include <type_traits>
#include <variant>

#include "jobs/stages/parameter.hpp"

namespace semigeo::jobs::cli {

/// Refuses NaN, which CLI::Range accepts.
inline std::string refuse_nan(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? "give a number" : "";
}

/// Refuses a negative number, with or without a unit: CLI11 would read "-1" as a huge size.
inline std::string refuse_negative(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first != std::string::npos && text[first] == '-' ? "give no negative number" : "";
}

/// Adds the option of one parameter to a command. It has a function for each kind of value.
template <typename Owner>
class AddOption {
 public:
  AddOption(CLI::App& command, const Parameter<Owner>& parameter, Owner& owner,
            std::string& tolerance)
      : command_(command),
        name_(std::string("--") + parameter.name),
        help_(parameter.help),
        owner_(owner),
        tolerance_(tolerance) {}

  template <typename Number>
  CLI::Option* operator()(const NumberIn<Owner, Number>& number) const {
    CLI::Option* option = command_.add_option(name_, number.field.edit(owner_), help_);
    option->check(CLI::Range(number.least, number.most));
    if (std::is_floating_point_v<Number>) option->check(refuse_nan);
    return option;
  }
  CLI::Option* operator()(const OptionalNumber<Owner>& number) const {
    return command_
        .add_option_function<int>(
            name_,
            [field = number.field, &owner = owner_](int value) { field.edit(owner) = value; },
            help_)
        ->check(CLI::Range(number.least, number.most));
  }
  CLI::Option* operator()(const Flag<Owner>& flag) const {
    if (flag.given) return command_.add_flag(name_, flag.field.edit(owner_), help_);
    const auto set = [field = flag.field, &owner = owner_](const CLI::results_t& results) {
      bool given = false;
      if (!CLI::detail::lexical_cast(results.front(), given)) return false;
      field.edit(owner) = !given;
      return true;
    };
    return command_.add_option(name_, set, help_)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
        ->expected(0);
  }
  CLI::Option* operator()(const Choice<Owner>& choice) const {
    const auto set = [choice, &owner = owner_](const std::string& word) {
      for (std::size_t i = 0; i < choice.words.size(); ++i)
        if (choice.words[i] == word) choice.choose(owner, i);
    };
    return command_.add_option_function<std::string>(name_, set, help_)
        ->default_str(choice.word(owner_))
        ->check(CLI::IsMember(choice.words));
  }
  CLI::Option* operator()(const Text<Owner>& text) const {
    CLI::Option* option = command_.add_option(name_, text.field.edit(owner_), help_);
    if (text.problem != nullptr) option->check(text.problem);
    return option;
  }
  CLI::Option* operator()(const Tolerance<Owner>&) const {
    return command_.add_option(name_, tolerance_, help_);
  }
  CLI::Option* operator()(const Size<Owner>& size) const {
    return command_.add_option(name_, size.field.edit(owner_), help_)
        ->transform(CLI::AsSizeValue(false))
        ->transform(CLI::Validator(refuse_negative, ""));
  }
  CLI::Option* operator()(const Duration<Owner>& duration) const {
    const std::map<std::string, double> units = {
        {"s", 1}, {"min", 60}, {"m", 60}, {"h", 3600}, {"d", 86400}};
    return command_.add_option(name_, duration.field.edit(owner_), help_)
        ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::UNIT_OPTIONAL, "DURATION"))
        ->transform(CLI::Validator(refuse_negative, ""));
  }
  CLI::Option* operator()(const Texts<Owner>& texts) const {
    return command_.add_option(name_, texts.field.edit(owner_), help_)
        ->default_str("")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  }

 private:
  CLI::App& command_;
  std::string name_;
  std::string help_;
  Owner& owner_;
  std::string& tolerance_;
};

/// Adds the options of a table to a command, in the order of its rows. They are bound to `owner`
/// and to `tolerance`, which must live until the command line is parsed. `tolerance` takes the text
/// of a Tolerance, which can be read only when the length unit is known.
template <typename Owner>
void add_table_options(CLI::App& command, const ParameterTable<Owner>& table, Owner& owner,
                       std::string& tolerance) {
  for (const Parameter<Owner>& row : table) {
    if (*row.name == '\0') continue;
    CLI::Option* option = std::visit(AddOption<Owner>(command, row, owner, tolerance), row.value);
    option->configurable(row.in_configuration);
    if (*row.excludes != '\0') option->excludes(std::string("--") + row.excludes);
  }
}

/// Adds the options of a table that has no Tolerance.
template <typename Owner>
void add_table_options(CLI::App& command, const ParameterTable<Owner>& table, Owner& owner) {
  static std::string no_tolerance;
  add_table_options(command, table, owner, no_tolerance);
}

}  // namespace semigeo::jobs::cli
