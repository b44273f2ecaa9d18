#pragma once

#include "engine/run_context.hpp"
#include "io/dataset/dataset.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

/// What of a surface recognition looks at; part of the key of a library.
struct RecognitionParameters {
  int levels = 4;           ///< octave levels 0, 1, ...
  int most_features = 400;  ///< of each level and kind, those that stand out most
  bool torsion = true;      ///< maxima of torsion as well as of curvature
  int samples = 4000;       ///< of the surface, at most
  /// Fine scans have more levels, until sigma is this share of the diagonal: what another scan of
  /// the object shows at its first level must be among them, however much coarser that is.
  double least_reach = 0.015;
  bool rim = false;  ///< mark samples near the boundary: of scenes; libraries do not store it
};

/// For a scene, of which a model may be a small part.
RecognitionParameters scene_parameters(const RecognitionParameters& of_models);

/// Features on octave levels, without rescaling, and samples of a built surface. The surface need
/// not be ordered.
kernels::RecognitionModel recognition_model(const kernels::BuiltSurface& built,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context);

/// The same of a dataset: its own features if it was made with octave levels, without rescaling and
/// with as many levels; otherwise its level 0 is evolved anew.
kernels::RecognitionModel recognition_model(const io::Dataset& dataset,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context);

}  // namespace semigeo::jobs
