#include "jobs/stages/search_parameters.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace semigeo::jobs {

std::string to_json(const SearchParameters& parameters) {
  const bool thesis = parameters.method == RecognitionMethod::kThesis;
  return nlohmann::json{{"method", thesis ? "thesis" : "overlap"},
                        {"min_score", parameters.min_score}}
      .dump();
}

SearchParameters search_parameters_from_json(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    SearchParameters parameters;
    if (json.at("method") == "thesis") parameters.method = RecognitionMethod::kThesis;
    json.at("min_score").get_to(parameters.min_score);
    return parameters;
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(std::string("are no parameters: ") + e.what());
  }
}

}  // namespace semigeo::jobs
