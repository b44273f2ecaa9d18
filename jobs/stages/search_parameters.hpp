#pragma once

#include <string>

#include "jobs/stages/recognise_scene.hpp"

namespace semigeo::jobs {

/// How models are found in a scene.
enum class RecognitionMethod {
  kOverlap,  ///< Surfaces are laid onto each other: stages/recognise_scene.hpp.
  kThesis    ///< Votes and clusters as in the thesis: stages/thesis_recognition.hpp.
};

/// What a recognition depends on besides the scene and the library.
struct SearchParameters {
  RecognitionMethod method = RecognitionMethod::kOverlap;
  double min_score = RecognitionOptions{}.min_score;  ///< A model with less is not in the scene.
};

/// Returns the parameters as JSON with sorted keys: the same parameters give the same text.
std::string to_json(const SearchParameters& parameters);

/// Reads what `to_json` returns. Throws std::runtime_error if a parameter is missing or is not of
/// its type.
SearchParameters search_parameters_from_json(const std::string& text);

}  // namespace semigeo::jobs
