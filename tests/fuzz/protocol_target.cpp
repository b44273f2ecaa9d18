// What a run, its child processes and the tasks of a cluster say to each other. The first byte
// chooses the message, the rest is its text.
#include <exception>

#include "io/files/error.hpp"
#include "jobs/kinds/all_kinds.hpp"
#include "jobs/run/job_line.hpp"
#include "jobs/slurm/slurm_commands.hpp"
#include "jobs/slurm/task_list.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

using jobs::JobReply;
using jobs::JobRequest;

void read_request(const std::string& line) {
  const JobRequest request = jobs::job_request_from(line, jobs::all_kinds());
  const std::string again = jobs::to_line(request);
  check(jobs::to_line(jobs::job_request_from(again, jobs::all_kinds())) == again,
        "a request is not read back");
}

/// The line holds the request of a job, and the text behind it is the answer.
void read_reply(const std::string& request_line, const std::string& line) {
  const JobReply reply = jobs::job_reply_from(line);
  const std::string again = jobs::to_line(reply);
  check(jobs::to_line(jobs::job_reply_from(again)) == again, "a reply is not read back");
  if (reply.kind != JobReply::Kind::kDone) return;
  const jobs::Job job = jobs::job_request_from(request_line, jobs::all_kinds()).job;
  const std::any result = job.kind->result_from_json(reply.result);
  job.kind->vertex_levels(result);
  jobs::JobEnded ended;
  job.kind->describe(job, result, ended);
  if (result.has_value()) job.kind->report(job, result);
}

void read_task(std::string_view text) {
  const std::filesystem::path list = write("tasks.jsonl", text);
  const jobs::Task task = jobs::read_task(list, 0, jobs::all_kinds());
  check(!task.jobs.empty(), "a task has no job");
  const std::string again = jobs::task_list_text(task.settings, {task.jobs});
  write("tasks.jsonl", again);
  const jobs::Task same = jobs::read_task(list, 0, jobs::all_kinds());
  check(jobs::task_list_text(same.settings, {same.jobs}) == again, "a task is not read back");
}

void read_results(std::string_view text) {
  const std::string again = jobs::results_text(jobs::read_results(write("0.jsonl", text)));
  check(jobs::results_text(jobs::read_results(write("0.jsonl", again))) == again,
        "results are not read back");
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  const unsigned kind = numbers.below(5);
  const std::string text(numbers.rest());
  const std::size_t end = std::min(text.find('\n'), text.size());
  try {
    if (kind == 0) read_request(text);
    if (kind == 1) read_reply(text.substr(0, end), text.substr(std::min(end + 1, text.size())));
    if (kind == 2) read_task(text);
    if (kind == 3) read_results(text);
    if (kind == 4) jobs::parse_queue(text);
  } catch (const std::exception&) {
    // The callers report every exception as a damaged line.
  }
}

}  // namespace semigeo::fuzz
