#include <fcntl.h>
#include <unistd.h>

#include "jobs/cli/command.hpp"
#include "jobs/worker.hpp"

namespace semigeo::jobs::cli {
namespace {

/// Where whoever started this process expects the answers; by hand, on standard output.
constexpr int kAnswers = 3;

}  // namespace

void add_job(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "job", "Do the jobs that lines on standard input describe: what `run` starts");
  command->footer(
      "Examples:\n"
      "  semigeo job < requests.jsonl     one line of JSON a job; answers on standard output, or "
      "on\n"
      "                                   descriptor 3 if that is open\n");
  command->callback([&exit_code] {
    const bool told = fcntl(kAnswers, F_GETFD) != -1;
    exit_code = serve_jobs(STDIN_FILENO, told ? kAnswers : STDOUT_FILENO);
  });
}

}  // namespace semigeo::jobs::cli
