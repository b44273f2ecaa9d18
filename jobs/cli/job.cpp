#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <new>

#include "engine/lack_of_memory.hpp"
#include "io/hdf5/hdf5.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/kinds/all_kinds.hpp"
#include "jobs/run/worker.hpp"
#include "jobs/slurm/task.hpp"

namespace semigeo::jobs::cli {
namespace {

/// The descriptor on which the parent process expects the answers. If it is closed, they go to
/// standard output.
constexpr int kAnswers = 3;

struct TaskOptions {
  std::filesystem::path list;
  int number = 0;
};

}  // namespace

void add_job(CLI::App& app, int& exit_code) {
  auto task = std::make_shared<TaskOptions>();
  CLI::App* command = app.add_subcommand(
      "job",
      "Do the jobs that lines on standard input, or a task of a list, describe: what `run` "
      "starts");
  command->footer(
      "Examples:\n"
      "  semigeo job < requests.jsonl     one line of JSON a job; answers on standard output, or "
      "on\n"
      "                                   descriptor 3 if that is open\n"
      "  semigeo job --list archive/slurm/RUN/tasks.jsonl --task 3\n"
      "                                   what Slurm starts: the jobs of a task, in child "
      "processes;\n"
      "                                   answers in results/3.jsonl beside the list. Exit codes: "
      "0\n"
      "                                   each job was done or has failed, 75 stopped before\n");
  CLI::Option* list =
      command->add_option("--list", task->list, "Tasks that a run has shared its jobs out to")
          ->default_str("");
  CLI::Option* number =
      command->add_option("--task", task->number, "Number of one of them")->needs(list);
  list->needs(number);
  command->callback([task, &exit_code] {
    if (!task->list.empty()) {
      const auto program = std::filesystem::read_symlink("/proc/self/exe");
      exit_code =
          run_task(task->list, task->number, program, all_kinds()) ? kAllDone : kStoppedEarly;
      return;
    }
    const bool told = fcntl(kAnswers, F_GETFD) != -1;
    engine::end_for_lack_of_memory("semigeo: there is not enough memory\n", engine::kNoMemoryCode);
    try {
      io::start_hdf5();  // before a job limits its memory
      exit_code = serve_jobs(STDIN_FILENO, told ? kAnswers : STDOUT_FILENO, all_kinds());
    } catch (const std::bad_alloc&) {
      exit_code = engine::kNoMemoryCode;
    }
  });
}

}  // namespace semigeo::jobs::cli
