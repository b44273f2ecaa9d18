#pragma once

namespace semigeo::jobs {

/// Does jobs until there are no more: reads a JobRequest a line from `requests`, answers with
/// JobReply lines on `answers`, the last of which is its outcome. While a job runs, standard output
/// and error go to its log, and its address space is limited; the log is removed if nothing was
/// written to it. Whatever a job throws is its failure; whatever kills the process is for the
/// reader of the answers to find out. Returns an exit code: 2 on a line that is no request, else 0.
///
/// SEMIGEO_TEST_FAULTS="NAME=FAULT,..." makes the jobs of these names (of surface jobs the
/// dataset's, of others "KIND NAME") crash, loop or take memory without end, or fail once: for
/// tests of those who run workers.
int serve_jobs(int requests, int answers);

}  // namespace semigeo::jobs
