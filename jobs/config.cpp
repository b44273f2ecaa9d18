#include "jobs/config.hpp"

#include <nlohmann/json.hpp>

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

}  // namespace semigeo::jobs
