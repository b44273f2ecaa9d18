#pragma once

#include <variant>

#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/surface_job.hpp"
#include "jobs/stages/triplets_job.hpp"

namespace semigeo::jobs {

/// What a job made, by its kind; nothing if it made nothing, or only a dataset's sidecar.
using JobResult = std::variant<std::monostate, SurfaceJobResult, TripletsJobResult,
                               PartitionJobResult, LibraryJobResult, RecogniseJobResult>;

}  // namespace semigeo::jobs
