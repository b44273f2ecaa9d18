#include "jobs/config.hpp"

#include <nlohmann/json.hpp>

namespace semigeo::jobs {

std::string to_json(const SurfaceParameters& parameters) {
  // nlohmann's object is an ordered map: keys come out sorted.
  return nlohmann::json{
      {"compression", parameters.compression == io::Compression::deflate ? "deflate" : "none"},
      {"length_unit", parameters.length_unit},
      {"levels", parameters.levels},
      {"step", parameters.step},
      {"surface", parameters.curved ? "curved" : "flat"}}
      .dump();
}

}  // namespace semigeo::jobs
