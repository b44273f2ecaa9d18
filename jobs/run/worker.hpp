#pragma once

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

/// Does jobs of these kinds until there are no more. Reads a JobRequest a line from the descriptor
/// `requests` and answers with JobReply lines on the descriptor `answers`; the last reply to a
/// request is its outcome. While a job runs, standard output and error go to its log, and the
/// address space of the process is limited; the log is removed if nothing was written to it.
/// Whatever a job throws is its failure; whatever kills the process is for the reader of the
/// answers to find out. A process that got no memory for a job does no more jobs, because libraries
/// may be left half changed. Returns an exit code: 2 on a line that is no request, else 0.
///
/// SEMIGEO_TEST_FAULTS="NAME=FAULT,..." makes jobs crash, loop or take memory without end, or fail
/// once. NAME is shown_name of a job. It serves tests of those who run workers.
int serve_jobs(int requests, int answers, const JobKinds& kinds);

}  // namespace semigeo::jobs
