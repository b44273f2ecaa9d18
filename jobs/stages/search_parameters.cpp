#include "jobs/stages/search_parameters.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "jobs/stages/depth_jump_row.hpp"
#include "jobs/stages/parameter_json.hpp"

namespace semigeo::jobs {

namespace {

constexpr double kKnownWithin = 1.1;  ///< Objects of known scale are larger or smaller by this.
constexpr const char* kScaleForms = "give any, known, or two positive numbers: 0.9..1.1";

/// Returns the number that is all of a text. Throws std::invalid_argument if there is none.
double positive_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value > 0) ||
      !std::isfinite(value))
    throw std::invalid_argument(kScaleForms);
  return value;
}

std::string problem_of_scale(const std::string& text) {
  try {
    scale_range(text);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

}  // namespace

ScaleRange scale_range(const std::string& text) {
  if (text == "any") return {};
  if (text == "known") return {1 / kKnownWithin, kKnownWithin};
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) throw std::invalid_argument(kScaleForms);
  const ScaleRange range = {positive_number(std::string_view(text).substr(0, dots)),
                            positive_number(std::string_view(text).substr(dots + 2))};
  if (range.least > range.most) throw std::invalid_argument(kScaleForms);
  return range;
}

const ParameterTable<SearchParameters>& search_parameter_table() {
  using Search = SearchParameters;
  using Method = RecognitionMethod;
  static const ParameterTable<Search> table = {
      {.key = "method",
       .name = "method",
       .help = "How: surfaces are laid onto each other, or the thesis' votes and clusters,\n"
               "which name one model, even if none is there",
       .value = choice(field<&Search::method>(),
                       {{"overlap", Method::kOverlap}, {"thesis", Method::kThesis}})},
      {.key = "view",
       .name = "view",
       .help = "Whether a scene was scanned from one place. What is hidden from there then says\n"
               "nothing against an object. auto: the file or the normals tell",
       .value = choice(field<&Search::view>(),
                       {{"auto", ViewChoice::kAuto}, {"none", ViewChoice::kNone}}),
       .default_in_json = false},
      {.key = "scale",
       .name = "scale",
       .help = "Sizes of objects in sizes of their models: any; known, if both have one unit\n"
               "(10 % more or less are allowed for); or LOW..HIGH",
       .value = Text<Search>{field<&Search::scale>(), problem_of_scale},
       .default_in_json = false},
      depth_jump_row(field<&Search::depth_jump>()),
      // Only `semigeo similar` sets it.
      {.key = "resemblance",
       .value = Flag<Search>{field<&Search::resemblance>()},
       .default_in_json = false},
      // Only `semigeo recognise` declares the option, because its default depends on the method.
      {.key = "min_score", .value = NumberIn<Search, double>{field<&Search::min_score>()}},
  };
  return table;
}

nlohmann::json json_of(const SearchParameters& parameters) {
  return json_of(search_parameter_table(), parameters);
}

std::string to_json(const SearchParameters& parameters) {
  return json_of(parameters).dump();
}

SearchParameters search_parameters_from_json(const nlohmann::json& json) {
  return from_json(search_parameter_table(), json);
}

}  // namespace semigeo::jobs
