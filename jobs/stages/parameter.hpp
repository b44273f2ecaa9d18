#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace semigeo::jobs {

// A table of parameters says everything about each of them once. The command line, the
// configuration file, JSON and docs/options.md are made from it.

/// Refers to a member of an Owner, at whatever depth. Use `field` to make it.
template <typename Owner, typename Value>
struct Field {
  const Value& (*get)(const Owner&);
  Value& (*edit)(Owner&);
};

template <typename Member>
struct MemberPointer;
template <typename Class, typename Type>
struct MemberPointer<Type Class::*> {
  using Owner = Class;
};

/// Returns the field at the end of a path of members, of which the first is a member of the owner:
/// `field<&SurfaceParameters::evolution, &EvolutionOptions::remesh>()`.
template <auto First, auto... Rest>
auto field() {
  using Owner = typename MemberPointer<decltype(First)>::Owner;
  using Value = std::remove_reference_t<decltype(((std::declval<Owner&>().*First).*....*Rest))>;
  return Field<Owner, Value>{
      [](const Owner& owner) -> const Value& { return ((owner.*First).*....*Rest); },
      [](Owner& owner) -> Value& { return ((owner.*First).*....*Rest); }};
}

/// A number between two bounds, both included.
template <typename Owner, typename Number>
struct NumberIn {
  Field<Owner, Number> field;
  Number least = std::numeric_limits<Number>::lowest();
  Number most = std::numeric_limits<Number>::max();
};

/// A number that need not be given.
template <typename Owner>
struct OptionalNumber {
  Field<Owner, std::optional<int>> field;
  int least = 0;
  int most = 0;
  const char* none = "";  ///< What JSON has if there is no number.
};

/// A choice that is on or off.
template <typename Owner>
struct Flag {
  Field<Owner, bool> field;
  bool given = true;  ///< The value of the field if the option is given.
};

/// One of several words. Use `choice` to make it.
template <typename Owner>
struct Choice {
  std::vector<std::string> words;
  /// Returns the index of the word, or words.size() if the value has none.
  std::function<std::size_t(const Owner&)> index;
  /// Gives the value the word of this index.
  std::function<void(Owner&, std::size_t)> choose;

  /// Returns the word of the value, or an empty text if it has none.
  std::string word(const Owner& owner) const {
    const std::size_t i = index(owner);
    return i < words.size() ? words[i] : std::string();
  }
};

/// Returns the choice between the values of a field, each under its word.
template <typename Owner, typename Value>
Choice<Owner> choice(Field<Owner, Value> field, std::vector<std::pair<const char*, Value>> values) {
  Choice<Owner> result;
  for (const auto& [word, value] : values) result.words.emplace_back(word);
  result.index = [field, values](const Owner& owner) {
    std::size_t i = 0;
    while (i < values.size() && values[i].second != field.get(owner)) ++i;
    return i;
  };
  result.choose = [field, values](Owner& owner, std::size_t i) {
    field.edit(owner) = values[i].second;
  };
  return result;
}

/// A text as it is given.
template <typename Owner>
struct Text {
  Field<Owner, std::string> field;
  /// Returns what is wrong with a text, or an empty string. Every text is right if there is none.
  std::string (*problem)(const std::string&) = nullptr;
};

/// A positive length in mean edge lengths ("0.1"), or in the length unit ("0.1mm").
template <typename Owner>
struct Tolerance {
  Field<Owner, double> value;
  Field<Owner, bool> in_length_units;
};

/// A number of bytes, given with or without a unit ("8G").
template <typename Owner>
struct Size {
  Field<Owner, std::uint64_t> field;
};

/// A number of seconds, given with or without another unit ("30min").
template <typename Owner>
struct Duration {
  Field<Owner, double> field;
};

/// A text that may be given several times.
template <typename Owner>
struct Texts {
  Field<Owner, std::vector<std::string>> field;
};

/// One row of a table: what a parameter is called, and which values it may have.
template <typename Owner>
struct Parameter {
  using Value =
      std::variant<NumberIn<Owner, int>, NumberIn<Owner, std::int64_t>, NumberIn<Owner, double>,
                   OptionalNumber<Owner>, Flag<Owner>, Choice<Owner>, Text<Owner>, Tolerance<Owner>,
                   Size<Owner>, Duration<Owner>, Texts<Owner>>;

  const char* key = "";  ///< The key in JSON; empty if JSON does not have the parameter.
  /// The option without its dashes, and the key in the configuration file; empty if there is none.
  const char* name = "";
  const char* help = "";  ///< The help text of the option, cut into lines by newlines.
  Value value;
  bool in_configuration = true;  ///< The configuration file may have it.
  bool default_in_json = true;   ///< JSON has the parameter even if it has its default.
  const char* excludes = "";     ///< The option of an earlier row that cannot be given with it.
};

/// Lists parameters in the order of the help text.
template <typename Owner>
using ParameterTable = std::vector<Parameter<Owner>>;

/// Returns the rows of several tables, one after the other.
template <typename Owner>
ParameterTable<Owner> joined(std::initializer_list<ParameterTable<Owner>> tables) {
  ParameterTable<Owner> result;
  for (const ParameterTable<Owner>& rows : tables)
    result.insert(result.end(), rows.begin(), rows.end());
  return result;
}

}  // namespace semigeo::jobs
