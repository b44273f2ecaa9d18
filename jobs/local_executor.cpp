#include "jobs/local_executor.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <map>
#include <numeric>
#include <set>

#include "engine/child_process.hpp"
#include "engine/descriptor.hpp"
#include "engine/machine.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "jobs/drain.hpp"
#include "jobs/job_line.hpp"
#include "jobs/scan_size.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using engine::ChildProcesses;
using Clock = std::chrono::steady_clock;

/// Limits are for what has gone wrong: generous beside the estimate, and never tight.
constexpr double kTimeoutFactor = 50;
constexpr double kLeastTimeout = 600;
constexpr std::uint64_t kMemoryFactor = 4;
constexpr std::uint64_t kLeastAddressSpace = std::uint64_t{2} << 30;
constexpr std::uint64_t kAddressSpacePerThread = std::uint64_t{192} << 20;  // stacks and arenas
constexpr std::size_t kLastLines = 3;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The last lines that a job printed, as one.
std::string last_lines(const fs::path& log) {
  std::ifstream stream(log);
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
  return "ended with exit code " + std::to_string(ended.exit_code) + " instead of an answer";
}

class Executor {
 public:
  Executor(const std::vector<PlannedJob>& plan, const SurfaceParameters& parameters,
           const ExecutorOptions& options, Progress& progress, JobListener* listener)
      : plan_(plan),
        parameters_(parameters),
        options_(options),
        progress_(progress),
        listener_(listener),
        total_(engine::usable_resources()),
        outcomes_(plan.size()),
        estimates_(plan.size()),
        drain_(children_) {
    if (options.threads > 0) total_.cores = options.threads;
    if (options.memory_bytes > 0) total_.bytes = options.memory_bytes;
    if (total_.bytes == 0) total_.bytes = std::uint64_t{1} << 62;  // Linux does not say
    resources_ = engine::Resources(total_);
  }

  std::vector<JobOutcome> run() {
    sort_out();
    while (true) {
      start_jobs();
      if (running_.empty()) break;
      handle(children_.wait());
    }
    if (options_.worker_log.empty()) remove_empty_logs(options_.logs);
    return std::move(outcomes_);
  }

 private:
  struct Running {
    std::size_t job;
    engine::Amount taken;
    double timeout;
    Clock::time_point start;
  };

  /// What need not run, what cannot, and the order of the rest.
  void sort_out() {
    for (std::size_t i = 0; i < plan_.size(); ++i) {
      if (plan_[i].up_to_date) {
        outcomes_[i].state = JobState::kUpToDate;
      } else if (!plan_[i].error.empty()) {
        progress_.scan_started(plan_[i].job.name);
        if (listener_ != nullptr) listener_->job_started(plan_[i]);
        fail(i, plan_[i].error);
      } else {
        if (!plan_[i].sidecar_only)
          estimates_[i] =
              options_.estimates.of(scan_size(plan_[i].job.input), parameters_.levels + 1, 1);
        seconds_left_ += estimates_[i].seconds;
        pending_.push_back(i);
      }
    }
    std::ranges::stable_sort(pending_, std::ranges::greater(),
                             [this](std::size_t i) { return estimates_[i].seconds; });
  }

  /// More than one only for what would otherwise be running when all else is done.
  int threads_for(std::size_t job) const {
    const double share = seconds_left_ > 0 ? estimates_[job].seconds / seconds_left_ : 1;
    return std::clamp(static_cast<int>(std::lround(share * total_.cores)), 1, total_.cores);
  }

  std::uint64_t bytes_of(std::size_t job) const {
    return static_cast<std::uint64_t>(estimates_[job].peak_bytes);
  }

  bool ends_in_time(std::size_t job) const {
    return options_.most_seconds <= 0 ||
           seconds_since(start_) + estimates_[job].seconds / threads_for(job) <=
               options_.most_seconds;
  }

  void start_jobs() {
    if (stopping_) return;
    while (true) {
      const auto next =
          std::ranges::find_if(pending_, [this](std::size_t job) { return ends_in_time(job); });
      if (next == pending_.end()) return;
      const std::size_t job = *next;
      const engine::Amount wanted = {threads_for(job), bytes_of(job)};
      // What is refused waits at the head of the queue: small jobs behind it must not starve it.
      if (!resources_.admit(wanted)) return;
      pending_.erase(next);
      start(job, wanted);
    }
  }

  void start(std::size_t job, engine::Amount taken) {
    if (idle_.empty()) idle_.push_back(start_worker());
    const ChildProcesses::Id child = idle_.back();
    idle_.pop_back();
    const PlannedJob& planned = plan_[job];
    const JobRequest request{.job = planned.job,
                             .parameters = parameters_,
                             .sidecar_only = planned.sidecar_only,
                             .threads = taken.cores,
                             .memory_bytes = address_space(job, taken.cores),
                             .log = log_of(job)};
    std::error_code ignored;
    if (outcomes_[job].attempts == 0) fs::remove(request.log, ignored);
    const double timeout = timeout_of(job);
    children_.restart_clocks(child, timeout * taken.cores, timeout);
    children_.send(child, to_line(request));
    running_[child] = {job, taken, timeout, Clock::now()};
    outcomes_[job].threads = taken.cores;
    if (outcomes_[job].attempts++ == 0) {
      progress_.scan_started(planned.job.name);
      if (listener_ != nullptr) listener_->job_started(planned);
    }
  }

  ChildProcesses::Id start_worker() {
    engine::Command command{.arguments = {options_.program.string(), "job"},
                            .limits = {},
                            .log = worker_log(),
                            .append_to_log = true,
                            .converses = true};
    // In somebody else's archive it may not be ours to write.
    const engine::Descriptor log(
        open(command.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    if (!log) command.log.clear();
    return children_.start(command);
  }

  fs::path worker_log() const {
    return options_.worker_log.empty() ? options_.logs / "workers.log" : options_.worker_log;
  }

  fs::path log_of(std::size_t job) const { return options_.logs / (plan_[job].job.name + ".log"); }

  std::uint64_t address_space(std::size_t job, int threads) const {
    if (options_.memory_per_job > 0) return options_.memory_per_job;
    return std::max(kLeastAddressSpace, kMemoryFactor * bytes_of(job)) +
           static_cast<std::uint64_t>(threads) * kAddressSpacePerThread;
  }

  double timeout_of(std::size_t job) const {
    if (options_.timeout_seconds > 0) return options_.timeout_seconds;
    return std::max(kLeastTimeout, kTimeoutFactor * estimates_[job].seconds);
  }

  void handle(const ChildProcesses::Event& event) {
    if (const auto* line = std::get_if<ChildProcesses::Line>(&event)) answered(*line);
    if (const auto* ended = std::get_if<ChildProcesses::Ended>(&event)) child_ended(*ended);
    if (std::holds_alternative<ChildProcesses::Woken>(event)) stop();
  }

  void answered(const ChildProcesses::Line& line) {
    const auto at = running_.find(line.child);
    if (at == running_.end()) return;
    JobReply reply;
    try {
      reply = job_reply_from(line.text);
    } catch (const std::exception&) {
      children_.kill(line.child);  // its end is the failure
      return;
    }
    progress_.worked(reply.worked);
    if (reply.kind == JobReply::Kind::kWorked) return;
    const std::size_t job = at->second.job;
    JobOutcome& outcome = outcomes_[job];
    outcome.cpu_seconds = reply.cpu_seconds;
    outcome.peak_bytes = reply.peak_bytes;
    outcome.result = std::move(reply.result);
    outcome.seconds = seconds_since(at->second.start);
    release(at);
    children_.restart_clocks(line.child, 0, 0);
    idle_.push_back(line.child);
    if (reply.kind == JobReply::Kind::kDone) {
      outcome.state = JobState::kDone;
      end(job);
    } else {
      fail(job, reply.error);
    }
  }

  void child_ended(const ChildProcesses::Ended& ended) {
    std::erase(idle_, ended.child);
    const auto at = running_.find(ended.child);
    if (at == running_.end()) return;
    const Running was = at->second;
    const PlannedJob& planned = plan_[was.job];
    outcomes_[was.job].seconds = seconds_since(was.start);
    release(at);
    io::remove_stale_partials(planned.job.output.parent_path());
    if (ending_) return;  // by us: the job has not run
    // Who ends this process by its group or container, as Slurm and systemd do, ends children too.
    if (ended.signal == SIGTERM && drain_.requests() > 0) return;
    const std::string cause = cause_of(ended, was.timeout);
    if (!stopping_ && outcomes_[was.job].attempts <= options_.retries) {
      progress_.say("again: " + planned.job.input.string() + ": " + cause);
      seconds_left_ += estimates_[was.job].seconds;
      pending_.insert(pending_.begin(), was.job);
      return;
    }
    const std::string printed = last_lines(log_of(was.job));
    const std::string where =  // an empty log is not kept
        printed.empty()
            ? "; "
            : "; it last said: " + printed + "; see " + log_of(was.job).string() + ", and ";
    fail(was.job, planned.job.input.string() + ": its job " + cause + where +
                      "run again or leave the scan out");
  }

  void release(std::map<ChildProcesses::Id, Running>::iterator at) {
    resources_.release(at->second.taken);
    seconds_left_ -= estimates_[at->second.job].seconds;
    running_.erase(at);
  }

  void fail(std::size_t job, const std::string& error) {
    outcomes_[job].state = JobState::kFailed;
    outcomes_[job].error = error;
    progress_.say("failed: " + error);
    end(job);
    if (options_.fail_fast) stopping_ = true;
  }

  void end(std::size_t job) {
    const bool done = outcomes_[job].state == JobState::kDone;
    progress_.scan_ended(done, bytes_to_read(plan_[job]));
    if (listener_ != nullptr) listener_->job_ended(plan_[job], outcomes_[job]);
  }

  /// A signal has come.
  void stop() {
    const int requests = drain_.requests();
    if (requests == 0) return;
    if (!stopping_)
      progress_.say("stopping: " + std::to_string(running_.size()) +
                    " running jobs may end; interrupt again to end them now");
    stopping_ = true;
    if (requests < 2) return;
    ending_ = true;
    for (const auto& [child, running] : running_) children_.kill(child);
  }

  const std::vector<PlannedJob>& plan_;
  const SurfaceParameters& parameters_;
  const ExecutorOptions& options_;
  Progress& progress_;
  JobListener* listener_;
  engine::Amount total_;
  engine::Resources resources_{{}};
  std::vector<JobOutcome> outcomes_;
  std::vector<Estimate> estimates_;
  std::vector<std::size_t> pending_;  ///< the longest first
  double seconds_left_ = 0;           ///< of one thread, for what is pending or running
  std::map<ChildProcesses::Id, Running> running_;
  std::vector<ChildProcesses::Id> idle_;
  bool stopping_ = false;
  bool ending_ = false;
  Clock::time_point start_ = Clock::now();
  ChildProcesses children_;
  Drain drain_;
};

}  // namespace

std::uintmax_t bytes_to_read(const PlannedJob& planned) {
  if (planned.up_to_date || planned.sidecar_only) return 0;
  std::error_code error;
  const auto size = fs::file_size(planned.job.input, error);
  return error ? 0 : size;
}

void remove_empty_logs(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& log : fs::directory_iterator(folder, ignored))
    if (log.path().extension() == ".log" && log.file_size(ignored) == 0)
      fs::remove(log.path(), ignored);
}

std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const SurfaceParameters& parameters,
                                 const ExecutorOptions& options, Progress& progress,
                                 JobListener* listener) {
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
  return Executor(plan, parameters, options, progress, listener).run();
}

}  // namespace semigeo::jobs
