#pragma once

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "io/files/json_value.hpp"
#include "jobs/stages/parameter.hpp"

namespace semigeo::jobs {

/// Returns the value of a parameter of `owner`.
template <typename Owner>
class ParameterToJson {
 public:
  explicit ParameterToJson(const Owner& owner) : owner_(owner) {}

  template <typename Kind>
  nlohmann::json operator()(const Kind& kind) const {
    return kind.field.get(owner_);
  }
  nlohmann::json operator()(const OptionalNumber<Owner>& number) const {
    const std::optional<int>& value = number.field.get(owner_);
    return value ? nlohmann::json(*value) : nlohmann::json(number.none);
  }
  nlohmann::json operator()(const Choice<Owner>& choice) const { return choice.word(owner_); }
  nlohmann::json operator()(const Tolerance<Owner>& tolerance) const {
    return nlohmann::json(tolerance.value.get(owner_)).dump() +
           (tolerance.in_length_units.get(owner_) ? " length units" : " edges");
  }

 private:
  const Owner& owner_;
};

/// Gives a parameter of `owner` the value that `json` has. Throws nlohmann::json::exception if it
/// is of another type; a word that is no choice changes nothing.
template <typename Owner>
class ParameterFromJson {
 public:
  ParameterFromJson(const nlohmann::json& json, Owner& owner) : json_(json), owner_(owner) {}

  template <typename Kind>
  void operator()(const Kind& kind) const {
    io::read_value(json_, kind.field.edit(owner_));
  }
  void operator()(const OptionalNumber<Owner>& number) const {
    if (json_ == number.none) return;
    int value = 0;
    io::read_value(json_, value);
    number.field.edit(owner_) = value;
  }
  void operator()(const Choice<Owner>& choice) const {
    for (std::size_t i = 0; i < choice.words.size(); ++i)
      if (json_ == choice.words[i]) choice.choose(owner_, i);
  }
  void operator()(const Tolerance<Owner>& tolerance) const {
    std::istringstream text(json_.get<std::string>());
    std::string unit;
    text >> tolerance.value.edit(owner_) >> unit;
    tolerance.in_length_units.edit(owner_) = unit == "length";
  }

 private:
  const nlohmann::json& json_;
  Owner& owner_;
};

/// Returns all parameters of the table as JSON with sorted keys.
template <typename Owner>
nlohmann::json json_of(const ParameterTable<Owner>& table, const Owner& owner) {
  auto json = nlohmann::json::object();  // an ordered map: keys come out sorted
  const Owner defaults;
  for (const Parameter<Owner>& parameter : table) {
    nlohmann::json value = std::visit(ParameterToJson<Owner>(owner), parameter.value);
    if (parameter.default_in_json ||
        value != std::visit(ParameterToJson<Owner>(defaults), parameter.value))
      json[parameter.key] = std::move(value);
  }
  return json;
}

/// Reads what `json_of` returns. Throws std::runtime_error if a parameter is missing or is not of
/// its type. Members that are not in the table are ignored.
template <typename Owner>
Owner from_json(const ParameterTable<Owner>& table, const nlohmann::json& json) {
  try {
    Owner owner;
    for (const Parameter<Owner>& parameter : table)
      if (parameter.default_in_json || json.contains(parameter.key))
        std::visit(ParameterFromJson<Owner>(json.at(parameter.key), owner), parameter.value);
    return owner;
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(std::string("are no parameters: ") + e.what());
  }
}

}  // namespace semigeo::jobs
