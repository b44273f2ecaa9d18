#pragma once

#include "engine/run_context.hpp"
#include "io/dataset/dataset.hpp"
#include "jobs/stages/recognition_parameters.hpp"
#include "kernels/recognition/recognition_model.hpp"
#include "kernels/repair/surface_builder.hpp"

namespace semigeo::jobs {

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
