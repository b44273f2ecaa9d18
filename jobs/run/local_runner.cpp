#include "jobs/run/local_runner.hpp"

#include <fcntl.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>

#include "engine/descriptor.hpp"
#include "engine/lack_of_memory.hpp"
#include "engine/machine.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/input_file.hpp"
#include "jobs/plan/job_kind.hpp"
#include "jobs/run/job_line.hpp"
#include "jobs/run/job_logs.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using engine::ChildProcesses;

// Limits are meant for jobs that have gone wrong, so they are much higher than the estimate.
constexpr double kTimeoutFactor = 50;
constexpr double kLeastTimeout = 600;
constexpr std::uint64_t kMemoryFactor = 4;
constexpr std::uint64_t kLeastAddressSpace = std::uint64_t{2} << 30;
constexpr std::uint64_t kAddressSpacePerThread = std::uint64_t{192} << 20;  // stacks and arenas
constexpr std::size_t kLastLines = 3;
/// With it, the allocator of glibc asks for huge pages, so that large arrays are zeroed faster.
constexpr const char* kHugePages = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";

/// Returns the end of a file, which may have any size. It is empty if the file cannot be read.
std::string end_of(const fs::path& path) {
  constexpr std::int64_t kMostBytes = 4096;
  try {
    const io::InputFile file(path);
    const std::int64_t begin = std::max<std::int64_t>(0, file.size() - kMostBytes);
    std::string text(static_cast<std::size_t>(file.size() - begin), '\0');
    text.resize(file.read_at(static_cast<std::uint64_t>(begin), text));
    return text;
  } catch (const io::Error&) {
    return "";
  }
}

/// Returns the last lines that a job has printed, as one line.
std::string last_lines(const fs::path& log) {
  std::istringstream stream(end_of(log));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    lines.push_back(line);
    if (lines.size() > kLastLines) lines.erase(lines.begin());
  }
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : " | ") + line;
  return text;
}

std::string cause_of(const ChildProcesses::Ended& ended, double timeout) {
  switch (ended.limit) {
    case ChildProcesses::Limit::kWallTime:
    case ChildProcesses::Limit::kCpuTime:
      return "took longer than " + short_duration(timeout) + " and was ended";
    case ChildProcesses::Limit::kLineLength:
      return "answered without end and was ended";
    case ChildProcesses::Limit::kNone:
      break;
  }
  if (ended.signal == SIGKILL)
    return "was killed (signal 9): by hand, or by the system because memory ran out";
  if (ended.signal != 0)
    return "crashed (signal " + std::to_string(ended.signal) + ", " + strsignal(ended.signal) + ")";
  if (ended.exit_code == engine::kNoMemoryCode) return "got no memory from the system";
  return "ended with exit code " + std::to_string(ended.exit_code) + " instead of an answer";
}

/// Returns the sentence about a job whose process was lost and is not tried again.
std::string sentence_about(const Job& job, const std::string& cause, const fs::path& log) {
  const JobWords& words = job.kind->words();
  const std::string printed = last_lines(log);
  const std::string where =  // because an empty log is not kept
      printed.empty() ? "; " : "; it last said: " + printed + "; see " + log.string() + ", and ";
  return subject_of(job).string() + ": its " + (words.stands_for_scan ? "" : words.kind + ' ') +
         "job " + cause + where + "run again" + words.kill_remedy;
}

}  // namespace

LocalRunner::LocalRunner(const ExecutorOptions& options) : options_(options), drain_(children_) {}

void LocalRunner::start(const std::vector<JobStart>& jobs, const Say&) {
  for (const JobStart& job : jobs) start(job);
}

/// A system that has no process, descriptor or memory for a job now may have one soon, and other
/// jobs are running. So the job counts as lost.
void LocalRunner::start(const JobStart& start) try {
  hand_over(start);
} catch (const std::system_error& e) {
  const Job& job = start.planned->job;
  const std::string cause = std::string("could not be started (") + e.what() + ")";
  unstarted_.push_back({.number = start.number,
                        .wanted = false,
                        .cause = cause,
                        .error = sentence_about(job, cause, {}),
                        .seconds = 0});
}

void LocalRunner::hand_over(const JobStart& start) {
  if (idle_.empty()) idle_.push_back(start_worker(*start.planned->job.kind));
  const Child child = idle_.back();
  idle_.pop_back();
  const JobRequest request{.job = start.planned->job,
                           .threads = start.share.cores,
                           .memory_bytes = options_.memory_bytes,
                           .address_space_bytes = address_space(start),
                           .log = log_of(start.planned->job)};
  std::error_code ignored;
  if (start.attempt == 1) fs::remove(request.log, ignored);
  const double timeout = timeout_of(start);
  children_.restart_clocks(child, timeout * request.threads, timeout);
  children_.send(child, to_line(request));
  running_.insert_or_assign(child, Running{start, timeout, steady_clock()});
}

/// Starts a process for jobs, of which the first will be one of the given kind.
LocalRunner::Child LocalRunner::start_worker(const JobKind& first) {
  engine::Command command{
      .arguments = {options_.program.string(), "job"},
      .limits = {},
      .environment = first.fills_large_arrays() ? std::vector<std::string>{kHugePages}
                                                : std::vector<std::string>{},
      .log = options_.worker_log.empty() ? options_.logs / "workers.log" : options_.worker_log,
      .append_to_log = true,
      .converses = true};
  // In somebody else's archive the log may not be writable.
  const engine::Descriptor log =
      engine::open_file(command.log, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK);
  if (!log) command.log.clear();
  return children_.start(command);
}

fs::path LocalRunner::log_of(const Job& job) const {
  return log_path(options_.logs, job);
}

std::uint64_t LocalRunner::address_space(const JobStart& job) const {
  if (options_.memory_per_job > 0) return options_.memory_per_job;
  const auto expected = static_cast<std::uint64_t>(job.estimate.peak_bytes);
  return std::max(kLeastAddressSpace, kMemoryFactor * expected) +
         static_cast<std::uint64_t>(job.share.cores) * kAddressSpacePerThread;
}

double LocalRunner::timeout_of(const JobStart& job) const {
  if (options_.timeout_seconds > 0) return options_.timeout_seconds;
  return std::max(kLeastTimeout, kTimeoutFactor * job.estimate.seconds);
}

RunnerEvent LocalRunner::wait() {
  if (!unstarted_.empty()) {
    JobLost lost = std::move(unstarted_.front());
    unstarted_.pop_front();
    return lost;
  }
  while (true) {
    const ChildProcesses::Event event = children_.wait();
    if (const auto* line = std::get_if<ChildProcesses::Line>(&event)) {
      const auto at = running_.find(line->child);
      if (at != running_.end()) return answered(at, line->text);
    } else if (const auto* ended = std::get_if<ChildProcesses::Ended>(&event)) {
      std::erase(idle_, ended->child);
      const auto at = running_.find(ended->child);
      if (at != running_.end()) return lost(at, *ended);
    } else if (std::holds_alternative<ChildProcesses::Woken>(event)) {
      return StopAsked{drain_.requests()};
    }
  }
}

RunnerEvent LocalRunner::answered(std::map<Child, Running>::iterator at, const std::string& line) {
  const Child child = at->first;
  const JobStart job = at->second.job;
  JobReply reply;
  JobOutcome outcome;
  try {
    reply = job_reply_from(line);
    outcome.result = job.planned->job.kind->result_from_json(reply.result);
  } catch (const std::exception&) {
    children_.kill(child);  // its end is reported as the failure
    return WorkDone{0};
  }
  if (reply.kind == JobReply::Kind::kWorked) return WorkDone{reply.worked};
  outcome.state = reply.kind == JobReply::Kind::kDone ? JobState::kDone : JobState::kFailed;
  outcome.error = std::move(reply.error);
  outcome.write_error = reply.write_error;
  outcome.seconds = at->second.clock();
  outcome.cpu_seconds = reply.cpu_seconds;
  outcome.peak_bytes = reply.peak_bytes;
  outcome.threads = job.share.cores;
  outcome.attempts = job.attempt;
  running_.erase(at);
  children_.restart_clocks(child, 0, 0);
  if (reply.last) {
    children_.close_input(child);
  } else {
    idle_.push_back(child);
  }
  return JobAnswered{job.number, std::move(outcome), reply.worked};
}

JobLost LocalRunner::lost(std::map<Child, Running>::iterator at,
                          const ChildProcesses::Ended& ended) {
  const Running was = std::move(at->second);
  running_.erase(at);
  const Job& job = was.job.planned->job;
  io::remove_stale_partials(job.output.parent_path());
  // A SIGTERM that came with a request to stop was sent to the whole run: Slurm and systemd signal
  // all processes of a group.
  const bool wanted = ending_ || (ended.signal == SIGTERM && drain_.requests() > 0);
  const std::string cause = cause_of(ended, was.timeout);
  return {.number = was.job.number,
          .wanted = wanted,
          .cause = cause,
          .error = sentence_about(job, cause, log_of(job)),
          .seconds = was.clock()};
}

std::string LocalRunner::stop_notice(std::size_t running) const {
  return "stopping: " + std::to_string(running) +
         " running jobs may end; interrupt again to end them now";
}

void LocalRunner::cancel_running() {
  ending_ = true;
  for (const auto& [child, running] : running_) children_.kill(child);
}

ExecutionSettings execution_settings(const ExecutorOptions& options) {
  engine::Amount total = engine::usable_resources();
  if (options.threads > 0) total.cores = options.threads;
  if (options.memory_bytes > 0) total.bytes = options.memory_bytes;
  if (total.bytes == 0) total.bytes = std::uint64_t{1} << 62;  // Linux does not say
  return {.total = total,
          .memory_bytes = options.memory_bytes,
          .most_seconds = options.most_seconds,
          .retries = options.retries,
          .fail_fast = options.fail_fast,
          .estimates = options.estimates};
}

void prepare_folders(const std::vector<PlannedJob>& plan, const ExecutorOptions& options) {
  std::set<fs::path> folders = {options.logs};
  for (const PlannedJob& planned : plan) folders.insert(planned.job.output.parent_path());
  for (const fs::path& folder : folders) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
      throw io::Error(folder, "", "cannot be created: " + error.message(),
                      "check the output folder, its permissions and the free space");
    io::remove_stale_partials(folder);
  }
}

std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const ExecutorOptions& options, Progress& progress,
                                 JobListener* listener) {
  prepare_folders(plan, options);
  LocalRunner runner(options);
  auto outcomes = execute(plan, runner, execution_settings(options), progress, listener);
  if (options.worker_log.empty()) remove_empty_logs(options.logs);
  return outcomes;
}

}  // namespace semigeo::jobs
