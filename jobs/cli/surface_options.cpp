#include "jobs/cli/surface_options.hpp"

#include <charconv>
#include <cmath>
#include <variant>

#include "jobs/cli/table_options.hpp"
#include "jobs/stages/parameter_json.hpp"

namespace semigeo::jobs::cli {
namespace {

/// The largest number of levels with --schedule octaves. There a patch reaches over a thousand
/// edges.
constexpr int kMostOctaveLevels = 16;

/// Reads "0.1", which is in mean edge lengths, or "0.1mm", which is in the length unit mm.
void set_tolerance(const std::string& text, SurfaceParameters& parameters) {
  if (text.empty()) return;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string unit(end, text.data() + text.size());
  if (error != std::errc() || !(value > 0) || !std::isfinite(value))
    throw CLI::ValidationError("--decimate", "give a positive number, alone or with a unit");
  if (!unit.empty() && unit != parameters.length_unit)
    throw CLI::ValidationError("--decimate", "the scans' unit is " + parameters.length_unit +
                                                 ", not " + unit + "; give --unit " + unit +
                                                 " if it is");
  parameters.preparation.decimate = value;
  parameters.preparation.decimate_in_length_units = !unit.empty();
}

/// Returns what the configuration file has for a parameter; null if it has nothing.
class ConfigValue {
 public:
  explicit ConfigValue(const SurfaceOptions& options) : options_(options) {}

  template <typename Kind>
  nlohmann::json operator()(const Kind& kind) const {
    return ParameterToJson<SurfaceParameters>(options_.parameters)(kind);
  }
  nlohmann::json operator()(const OptionalNumber<SurfaceParameters>& number) const {
    const std::optional<int>& value = number.field.get(options_.parameters);
    return value ? nlohmann::json(*value) : nlohmann::json();
  }
  nlohmann::json operator()(const Flag<SurfaceParameters>& flag) const {
    return flag.field.get(options_.parameters) == flag.given;
  }
  nlohmann::json operator()(const Tolerance<SurfaceParameters>& /*tolerance*/) const {
    return options_.tolerance;
  }

 private:
  const SurfaceOptions& options_;
};

}  // namespace

void add_surface_options(CLI::App& command, SurfaceOptions& options) {
  add_table_options(command, surface_parameter_table(), options.parameters, options.tolerance);
}

void complete(SurfaceOptions& options) {
  SurfaceParameters& parameters = options.parameters;
  set_tolerance(options.tolerance, parameters);
  if (parameters.evolution.schedule == Schedule::kOctaves && parameters.levels > kMostOctaveLevels)
    throw CLI::ValidationError("--levels",
                               "two levels of --schedule octaves double the scale; give at most " +
                                   std::to_string(kMostOctaveLevels));
  if (parameters.recognition_level > parameters.levels)
    throw CLI::ValidationError("--level", "the levels are 0 to " +
                                              std::to_string(parameters.levels) +
                                              "; give one of them, or more --levels");
}

std::string config_text(const SurfaceOptions& options) {
  std::string text = "# Effective configuration; use it again with --config.\n[run]\n";
  for (const Parameter<SurfaceParameters>& row : surface_parameter_table()) {
    const nlohmann::json value = std::visit(ConfigValue(options), row.value);
    // JSON's numbers, booleans and strings are TOML's.
    if (!value.is_null()) text += std::string(row.name) + " = " + value.dump() + '\n';
  }
  return text;
}

}  // namespace semigeo::jobs::cli
