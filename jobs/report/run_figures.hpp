#pragma once

#include <nlohmann/json_fwd.hpp>

#include "jobs/report/run_history.hpp"

namespace semigeo::jobs {

/// Returns the figures of a run that the first page shows:
///
///   started, seconds, version, host, threads, passed_over, ended (jobs by state)
///   vertex_levels_per_second
///   cpu_seconds, peak_bytes
///   core_time   what the cores did from the start to the last end, as shares: `computing`,
///               `waiting` (a job had the core, but did not compute: it waited for the disk or for
///               other programs), `held` (no job had the core, and some were left that could not
///               begin, for want of memory or of other jobs' results), `tail` (no job had the core,
///               after the last one had begun)
///   curve       throughput over the run: `seconds` of a step, `rate` (vertex levels per second)
///               and `cores` (cores that jobs had), a number for each step
///
/// The work of a job is spread evenly over its time. The journal has times in whole seconds, so
/// that runs of less than ten seconds have neither `core_time` nor `curve`.
nlohmann::json figures_of(const LastRun& run);

}  // namespace semigeo::jobs
