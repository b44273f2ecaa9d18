#include "jobs/stages/recognition_parameters.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace semigeo::jobs {

std::string to_json(const RecognitionParameters& parameters) {
  return nlohmann::json{{"least_reach", parameters.least_reach},
                        {"levels", parameters.levels},
                        {"most_features", parameters.most_features},
                        {"samples", parameters.samples},
                        {"torsion", parameters.torsion}}
      .dump();
}

RecognitionParameters recognition_parameters_from_json(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    RecognitionParameters parameters;
    json.at("least_reach").get_to(parameters.least_reach);
    json.at("levels").get_to(parameters.levels);
    json.at("most_features").get_to(parameters.most_features);
    json.at("samples").get_to(parameters.samples);
    json.at("torsion").get_to(parameters.torsion);
    return parameters;
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(std::string("are no parameters: ") + e.what());
  }
}

RecognitionParameters scene_parameters(const RecognitionParameters& of_models) {
  RecognitionParameters parameters = of_models;
  parameters.samples = 5 * of_models.samples;
  parameters.rim = true;
  return parameters;
}

}  // namespace semigeo::jobs
