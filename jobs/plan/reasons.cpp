#include "jobs/plan/reasons.hpp"

#include <algorithm>
#include <set>

namespace semigeo::jobs {
namespace {

using Kind = Reason::Kind;

/// Returns a digest, a version or words.
std::string text_in(const nlohmann::json& value) {
  return value.is_string() ? value.get<std::string>() : "";
}

std::string shown(const nlohmann::json& value) {
  return value.is_null() ? "none" : value.dump();
}

nlohmann::json value_in(const nlohmann::json& parameters, const std::string& name) {
  return parameters.is_object() ? parameters.value(name, nlohmann::json()) : nlohmann::json();
}

}  // namespace

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::kNoDataset:
      return "no dataset";
    case Kind::kUnusableDataset:
      return "unusable dataset";
    case Kind::kDamagedArrays:
      return "damaged arrays";
    case Kind::kScan:
      return "scan";
    case Kind::kParameter:
      return "parameter";
    case Kind::kProgram:
      return "program";
    case Kind::kNoSidecar:
      return "no sidecar";
    case Kind::kDamagedSidecar:
      return "damaged sidecar";
    case Kind::kNoOutput:
      return "no output";
    case Kind::kUnusableOutput:
      return "unusable output";
    case Kind::kDamagedOutput:
      return "damaged output";
    case Kind::kInputs:
      break;
  }
  return "inputs";
}

std::string in_words(const Reason& reason) {
  const std::string before = text_in(reason.before);
  const std::string now = text_in(reason.now);
  switch (reason.kind) {
    case Kind::kNoDataset:
      return "no dataset yet";
    case Kind::kUnusableDataset:
    case Kind::kDamagedArrays:
      return "dataset: " + now;
    case Kind::kScan:
      return "scan: other bytes; XXH3 " + before + ", now " + now;
    case Kind::kParameter:
      return "parameter " + reason.parameter + ": " + shown(reason.before) + ", now " +
             shown(reason.now);
    case Kind::kProgram:
      return "program: what made the dataset, version " + before + ", computed something else";
    case Kind::kNoSidecar:
      return ".xdmf: missing; it is made from the dataset";
    case Kind::kDamagedSidecar:
      return ".xdmf: does not say what the dataset holds; it is made from the dataset";
    case Kind::kNoOutput:
      return "no " + before + " yet";
    case Kind::kUnusableOutput:
      return before + ": damaged, incomplete or of another version";
    case Kind::kDamagedOutput:
      return before + ": " + now;
    case Kind::kInputs:
      break;
  }
  return now + ", the parameters or the program: not those that the " + before + " was made of";
}

std::string in_short(const std::vector<Reason>& reasons) {
  if (reasons.empty()) return "";
  const auto has = [&](Kind kind) { return std::ranges::count(reasons, kind, &Reason::kind) > 0; };
  if (has(Kind::kNoDataset)) return "no dataset yet";
  if (has(Kind::kUnusableDataset)) return "the dataset is damaged, incomplete or of another format";
  if (has(Kind::kDamagedArrays)) return "its arrays are damaged";
  const Reason& first = reasons.front();
  if (has(Kind::kNoOutput)) return in_words(first);
  if (has(Kind::kUnusableOutput) || has(Kind::kDamagedOutput))
    return "the " + text_in(first.before) + " is damaged, incomplete or of another version";
  if (has(Kind::kInputs)) return text_in(first.now) + ", the parameters or the program changed";
  if (has(Kind::kNoSidecar)) return "its .xdmf is missing";
  if (has(Kind::kDamagedSidecar)) return "its .xdmf is damaged";
  std::vector<std::string> changed;
  if (has(Kind::kScan)) changed.emplace_back("the scan");
  if (has(Kind::kParameter)) changed.emplace_back("the parameters");
  if (has(Kind::kProgram)) changed.emplace_back("the program");
  std::string text = changed.front();
  for (std::size_t i = 1; i < changed.size(); ++i)
    text += (i + 1 < changed.size() ? ", " : " and ") + changed[i];
  return text + " changed";
}

std::vector<Reason> parameter_differences(const nlohmann::json& before, const nlohmann::json& now) {
  std::set<std::string> names;
  for (const nlohmann::json* values : {&before, &now})
    if (values->is_object())
      for (const auto& [name, value] : values->items()) names.insert(name);
  std::vector<Reason> differences;
  for (const std::string& name : names) {
    Reason reason{.kind = Kind::kParameter,
                  .parameter = name,
                  .before = value_in(before, name),
                  .now = value_in(now, name)};
    // As JSON values, 1 and 1.0 would be the same.
    if (reason.before.dump() != reason.now.dump()) differences.push_back(std::move(reason));
  }
  return differences;
}

}  // namespace semigeo::jobs
