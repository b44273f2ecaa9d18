#include "jobs/stages/search_parameters.hpp"

#include "jobs/stages/depth_jump_row.hpp"
#include "jobs/stages/parameter_json.hpp"

namespace semigeo::jobs {

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
      depth_jump_row(field<&Search::depth_jump>()),
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
