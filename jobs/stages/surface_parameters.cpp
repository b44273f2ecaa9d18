#include "jobs/stages/surface_parameters.hpp"

#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace semigeo::jobs {

namespace {

const char* name_of(Rescale rescale) {
  switch (rescale) {
    case Rescale::size:
      return "size";
    case Rescale::edges:
      return "edges";
    case Rescale::none:
      break;
  }
  return "none";
}

}  // namespace

std::string to_json(const SurfaceParameters& parameters) {
  const PreparationOptions& preparation = parameters.preparation;
  const auto tolerance = nlohmann::json(preparation.decimate).dump() +
                         (preparation.decimate_in_length_units ? " length units" : " edges");
  const EvolutionOptions& evolution = parameters.evolution;
  const bool polar = evolution.coordinates == kernels::Coordinates::polar;
  // nlohmann's object is an ordered map: keys come out sorted.
  return nlohmann::json{
      {"compression", parameters.compression == io::Compression::deflate ? "deflate" : "none"},
      {"decimate", tolerance},
      {"feature_completeness", parameters.features.min_completeness},
      {"feature_radius", parameters.features.radius},
      {"fill_holes", preparation.fill_holes},
      {"target_vertices", preparation.target_vertices},
      {"coordinates", polar ? "polar" : "semigeodesic"},
      {"length_unit", parameters.length_unit},
      {"level", parameters.recognition_level ? nlohmann::json(*parameters.recognition_level)
                                             : nlohmann::json("slope")},
      {"levels", parameters.levels},
      {"principal", evolution.principal},
      {"remesh", evolution.remesh},
      {"rescale", name_of(evolution.rescale)},
      {"schedule", evolution.schedule == Schedule::octaves ? "octaves" : "uniform"},
      {"step", evolution.step_factor},
      {"surface", evolution.curved ? "curved" : "flat"}}
      .dump();
}

SurfaceParameters surface_parameters_from_json(const std::string& text) {
  try {
    const auto json = nlohmann::json::parse(text);
    const auto is = [&](const char* key, const char* word) { return json.at(key) == word; };
    SurfaceParameters parameters;
    PreparationOptions& preparation = parameters.preparation;
    std::istringstream tolerance(json.at("decimate").get<std::string>());
    std::string unit;
    tolerance >> preparation.decimate >> unit;
    preparation.decimate_in_length_units = unit == "length";
    json.at("fill_holes").get_to(preparation.fill_holes);
    json.at("target_vertices").get_to(preparation.target_vertices);
    EvolutionOptions& evolution = parameters.evolution;
    evolution.curved = is("surface", "curved");
    if (is("coordinates", "polar")) evolution.coordinates = kernels::Coordinates::polar;
    if (is("schedule", "octaves")) evolution.schedule = Schedule::octaves;
    for (const Rescale rescale : {Rescale::size, Rescale::edges, Rescale::none})
      if (is("rescale", name_of(rescale))) evolution.rescale = rescale;
    json.at("remesh").get_to(evolution.remesh);
    json.at("principal").get_to(evolution.principal);
    json.at("step").get_to(evolution.step_factor);
    json.at("feature_completeness").get_to(parameters.features.min_completeness);
    json.at("feature_radius").get_to(parameters.features.radius);
    json.at("levels").get_to(parameters.levels);
    if (!is("level", "slope")) parameters.recognition_level = json.at("level").get<int>();
    json.at("length_unit").get_to(parameters.length_unit);
    if (is("compression", "none")) parameters.compression = io::Compression::none;
    if (to_json(parameters) != json.dump())
      throw std::runtime_error("are no parameters of this version: " + text);
    return parameters;
  } catch (const nlohmann::json::exception& e) {
    throw std::runtime_error(std::string("are no parameters: ") + e.what());
  }
}

}  // namespace semigeo::jobs
