#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace semigeo::jobs {

/// Says what recognition looks at on a surface. It is part of the key of a library.
struct RecognitionParameters {
  int levels = 4;           ///< Number of octave levels 0, 1, ... of a coarse scan.
  int most_features = 400;  ///< Largest number of features of each level and kind, the strongest.
  bool torsion = true;      ///< Maxima of torsion are features, as maxima of curvature are.
  int samples = 4000;       ///< Largest number of samples of the surface.
  /// Fine scans get more levels, until sigma is this share of the diagonal. Their scales must
  /// include that of the first level of a much coarser scan of the same object.
  double least_reach = 0.015;
  bool rim = false;  ///< Samples near the boundary are marked; libraries do not store the marks.
};

/// Returns the parameters for a scene, of which a model may be a small part.
RecognitionParameters scene_parameters(const RecognitionParameters& of_models);

/// Returns the parameters as JSON with sorted keys. A library depends on them.
nlohmann::json json_of(const RecognitionParameters& parameters);

/// Returns that JSON as text: the same parameters give the same text.
std::string to_json(const RecognitionParameters& parameters);

/// Reads what `json_of` returns. Throws std::runtime_error if a parameter is missing or is not of
/// its type.
RecognitionParameters recognition_parameters_from_json(const nlohmann::json& json);

}  // namespace semigeo::jobs
