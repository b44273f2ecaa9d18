#pragma once

#include "engine/run_context.hpp"
#include "io/dataset/dataset.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

/// Returns the features of a built surface on octave levels without rescaling, and samples of the
/// surface. The surface need not be ordered. The result does not depend on the number of threads.
kernels::RecognitionModel recognition_model(const kernels::BuiltSurface& built,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context);

/// Returns the features and samples of a dataset. The features are its own if it has as many octave
/// levels; otherwise its level 0 is evolved anew. Throws io::Error if the dataset cannot be read.
kernels::RecognitionModel recognition_model(const io::Dataset& dataset,
                                            const RecognitionParameters& parameters,
                                            const engine::RunContext& context);

}  // namespace semigeo::jobs
