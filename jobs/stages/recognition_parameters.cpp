#include "jobs/stages/recognition_parameters.hpp"

#include "jobs/stages/parameter_json.hpp"

namespace semigeo::jobs {
namespace {

/// The rows have keys only, because no option sets these parameters.
const ParameterTable<RecognitionParameters>& table() {
  using Recognition = RecognitionParameters;
  using Integer = NumberIn<Recognition, int>;
  using Number = NumberIn<Recognition, double>;
  static const ParameterTable<Recognition> rows = {
      {.key = "least_reach", .value = Number{field<&Recognition::least_reach>()}},
      {.key = "levels", .value = Integer{field<&Recognition::levels>()}},
      {.key = "most_features", .value = Integer{field<&Recognition::most_features>()}},
      {.key = "samples", .value = Integer{field<&Recognition::samples>()}},
      {.key = "torsion", .value = Flag<Recognition>{field<&Recognition::torsion>()}},
  };
  return rows;
}

}  // namespace

RecognitionParameters scene_parameters(const RecognitionParameters& of_models) {
  RecognitionParameters parameters = of_models;
  parameters.samples = 5 * of_models.samples;
  parameters.rim = true;
  return parameters;
}

nlohmann::json json_of(const RecognitionParameters& parameters) {
  return json_of(table(), parameters);
}

std::string to_json(const RecognitionParameters& parameters) {
  return json_of(parameters).dump();
}

RecognitionParameters recognition_parameters_from_json(const nlohmann::json& json) {
  return from_json(table(), json);
}

}  // namespace semigeo::jobs
