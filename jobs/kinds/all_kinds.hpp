#pragma once

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

/// Returns the kinds of jobs that the program can do.
const JobKinds& all_kinds();

}  // namespace semigeo::jobs
