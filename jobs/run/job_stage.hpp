#pragma once

#include "engine/run_context.hpp"
#include "jobs/plan/config.hpp"
#include "jobs/plan/job.hpp"
#include "jobs/run/job_result.hpp"

namespace semigeo::jobs {

/// Does a job, in this process: where its kind meets the stage that does it. Throws what that does.
JobResult run_stage(const Job& job, const JobParameters& parameters,
                    const engine::RunContext& context);

}  // namespace semigeo::jobs
