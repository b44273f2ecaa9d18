#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "jobs/stages/parameter.hpp"
#include "jobs/stages/recognise_scene.hpp"
#include "kernels/repair/range_grid.hpp"

namespace semigeo::jobs {

/// The methods by which models are found in a scene.
enum class RecognitionMethod {
  kOverlap,  ///< Surfaces are laid onto each other: stages/recognise_scene.hpp.
  kThesis    ///< Votes and clusters as in the thesis: stages/thesis_recognition.hpp.
};

/// How it is found out whether a scene was scanned from one place, and from where.
enum class ViewChoice {
  kAuto,  ///< The file names the place, or the normals tell: kernels::eye_of_view.
  kNone   ///< No scene is taken to be scanned from one place.
};

/// Holds all that a recognition depends on besides the scene and the library.
struct SearchParameters {
  RecognitionMethod method = RecognitionMethod::kOverlap;
  double min_score = RecognitionOptions{}.min_score;  ///< A model with less is not in the scene.
  double depth_jump = kernels::kDepthJump;            ///< See `kernels::triangulate_grid`.
  ViewChoice view = ViewChoice::kAuto;
  std::string scale = "any";  ///< What `scale_range` reads.
  bool resemblance = false;   ///< Models are compared with the scene as a whole, too.
};

/// Returns the sizes that objects may have: "any"; "known" if models and scene have one unit, which
/// allows for 10 % more or less; or two numbers, "LOW..HIGH". Throws std::invalid_argument if the
/// text is none of these.
ScaleRange scale_range(const std::string& text);

/// Returns what each of the parameters is called and which values it may have. A parameter is
/// declared there and nowhere else.
const ParameterTable<SearchParameters>& search_parameter_table();

/// Returns the parameters as JSON with sorted keys.
nlohmann::json json_of(const SearchParameters& parameters);

/// Returns that JSON as text: the same parameters give the same text.
std::string to_json(const SearchParameters& parameters);

/// Reads what `json_of` returns. Throws std::runtime_error if a parameter is missing or is not of
/// its type.
SearchParameters search_parameters_from_json(const nlohmann::json& json);

}  // namespace semigeo::jobs
