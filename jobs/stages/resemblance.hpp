#pragma once

#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::jobs {

/// Returns how much each model of a library resembles a scene as a whole, whatever its size and
/// place: kernels::resemblance of their histograms. Reads every model. The result does not depend
/// on the number of threads. Throws io::Error if the library cannot be read.
std::vector<double> resemblances(const io::HashLibrary& library,
                                 const kernels::RecognitionModel& scene,
                                 const engine::RunContext& context);

}  // namespace semigeo::jobs
