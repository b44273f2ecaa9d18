#include "jobs/run/local_executor.hpp"

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
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "jobs/plan/job_estimates.hpp"
#include "jobs/plan/job_inputs.hpp"
#include "jobs/run/drain.hpp"
#include "jobs/run/job_line.hpp"

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
  Executor(const std::vector<PlannedJob>& plan, const JobParameters& parameters,
           const ExecutorOptions& options, Progress& progress, JobListener* listener)
      : plan_(plan),
        parameters_(parameters),
        options_(options),
        progress_(progress),
        listener_(listener),
        total_(engine::usable_resources()),
        inputs_(parameters.recognition),
        outcomes_(plan.size()),
        waits_for_(plan.size()),
        followers_(plan.size()),
        drain_(children_) {
    if (options.threads > 0) total_.cores = options.threads;
    if (options.memory_bytes > 0) total_.bytes = options.memory_bytes;
    if (total_.bytes == 0) total_.bytes = std::uint64_t{1} << 62;  // Linux does not say
    resources_ = engine::Resources(total_);
    estimates_ = estimates_of(plan_, parameters_, options_.estimates, options_.memory_bytes);
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
      for (const std::size_t before : plan_[i].after) {
        if (has_ended(outcomes_[before].state)) continue;
        followers_[before].push_back(i);
        ++waits_for_[i];
      }
      if (plan_[i].up_to_date) {
        outcomes_[i].state = JobState::kUpToDate;
      } else if (!plan_[i].error.empty()) {
        progress_.job_started(shown_name(i));
        if (listener_ != nullptr) listener_->job_started(plan_[i]);
        fail(i, plan_[i].error);
      } else {
        if (waits_for_[i] == 0) seconds_left_ += estimates_[i].seconds;
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

  bool may_start(std::size_t job) const {
    if (waits_for_[job] > 0) return false;
    return options_.most_seconds <= 0 ||
           seconds_since(start_) + estimates_[job].seconds / threads_for(job) <=
               options_.most_seconds;
  }

  void start_jobs() {
    while (!stopping_) {
      const auto next =
          std::ranges::find_if(pending_, [this](std::size_t job) { return may_start(job); });
      if (next == pending_.end()) return;
      const std::size_t job = *next;
      if (!has_inputs(job)) {
        pending_.erase(next);
        continue;
      }
      const engine::Amount wanted = {threads_for(job), bytes_of(job)};
      // What is refused waits at the head of the queue: small jobs behind it must not starve it.
      if (!resources_.admit(wanted)) return;
      pending_.erase(next);
      start(job, wanted);
    }
  }

  /// Looks at what there is now; ends with what need not run, or cannot.
  bool has_inputs(std::size_t job) {
    PlannedJob& planned = plan_[job];
    if (planned.job.kind == JobKind::kSurface || outcomes_[job].attempts > 0) return true;
    if (planned.inputs_are_there) {
      remove_stale_run(planned.job);
      return true;
    }
    bool up_to_date = false;
    try {
      up_to_date = inputs_.settle(planned.job);
    } catch (const io::Error& e) {
      remove_stale_run(planned.job);
      seconds_left_ -= estimates_[job].seconds;
      const bool follows = std::ranges::any_of(planned.after, [this](std::size_t before) {
        return outcomes_[before].state == JobState::kFailed ||
               outcomes_[before].state == JobState::kSkipped;
      });
      if (!follows) {
        fail(job, e.what());
        return false;
      }
      outcomes_[job].error = e.what();
      end(job, JobState::kSkipped);
      return false;
    }
    if (up_to_date) {
      seconds_left_ -= estimates_[job].seconds;
      end(job, JobState::kUpToDate);
      return false;
    }
    remove_stale_run(planned.job);
    return true;
  }

  void start(std::size_t job, engine::Amount taken) {
    if (idle_.empty()) idle_.push_back(start_worker());
    const ChildProcesses::Id child = idle_.back();
    idle_.pop_back();
    PlannedJob& planned = plan_[job];
    planned.job.buffer_bytes = buffer_bytes(options_.memory_bytes);
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
      progress_.job_started(shown_name(job));
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

  fs::path log_of(std::size_t job) const { return log_path(options_.logs, plan_[job].job); }

  std::string shown_name(std::size_t job) const {
    const Job& shown = plan_[job].job;
    return shown.kind == JobKind::kSurface ? shown.name : job_id(shown);
  }

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
      end(job, JobState::kDone);
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
      progress_.say("again: " + subject_of(planned.job).string() + ": " + cause);
      seconds_left_ += estimates_[was.job].seconds;
      pending_.insert(pending_.begin(), was.job);
      return;
    }
    const std::string printed = last_lines(log_of(was.job));
    const std::string where =  // an empty log is not kept
        printed.empty()
            ? "; "
            : "; it last said: " + printed + "; see " + log_of(was.job).string() + ", and ";
    const bool has_scan = planned.job.kind == JobKind::kSurface;
    fail(was.job, subject_of(planned.job).string() + ": its " +
                      (has_scan ? "" : std::string(name_of(planned.job.kind)) + ' ') + "job " +
                      cause + where + "run again" + (has_scan ? " or leave the scan out" : ""));
  }

  void release(std::map<ChildProcesses::Id, Running>::iterator at) {
    resources_.release(at->second.taken);
    seconds_left_ -= estimates_[at->second.job].seconds;
    running_.erase(at);
  }

  void fail(std::size_t job, const std::string& error) {
    outcomes_[job].error = error;
    progress_.say("failed: " + error);
    end(job, JobState::kFailed);
    if (options_.fail_fast) stopping_ = true;
  }

  void end(std::size_t job, JobState state) {
    outcomes_[job].state = state;
    for (const std::size_t follower : followers_[job])
      if (--waits_for_[follower] == 0 && plan_[follower].error.empty() &&
          !plan_[follower].up_to_date)
        seconds_left_ += estimates_[follower].seconds;
    progress_.job_ended(state != JobState::kFailed, bytes_to_read(plan_[job]));
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

  std::vector<PlannedJob> plan_;  ///< jobs of the inputs that are there, once they have begun
  const JobParameters& parameters_;
  const ExecutorOptions& options_;
  Progress& progress_;
  JobListener* listener_;
  engine::Amount total_;
  engine::Resources resources_{{}};
  JobInputs inputs_;
  std::vector<JobOutcome> outcomes_;
  std::vector<Estimate> estimates_ = {};
  std::vector<std::size_t> waits_for_;               ///< so many jobs that have not ended
  std::vector<std::vector<std::size_t>> followers_;  ///< jobs that wait for this one
  std::vector<std::size_t> pending_;                 ///< the longest first
  double seconds_left_ = 0;  ///< of one thread, for what is running or waits for no other job
  std::map<ChildProcesses::Id, Running> running_;
  std::vector<ChildProcesses::Id> idle_;
  bool stopping_ = false;
  bool ending_ = false;
  Clock::time_point start_ = Clock::now();
  ChildProcesses children_;
  Drain drain_;
};

}  // namespace

std::string_view name_of(JobState state) {
  switch (state) {
    case JobState::kDone:
      return "done";
    case JobState::kUpToDate:
      return "up to date";
    case JobState::kFailed:
      return "failed";
    case JobState::kSkipped:
      return "skipped";
    case JobState::kNotRun:
      break;
  }
  return "not run";
}

std::uintmax_t bytes_to_read(const PlannedJob& planned) {
  if (planned.up_to_date || planned.sidecar_only || planned.job.kind != JobKind::kSurface) return 0;
  std::error_code error;
  const auto size = fs::file_size(planned.job.input, error);
  return error ? 0 : size;
}

fs::path log_path(const fs::path& logs, const Job& job) {
  // Names of datasets end in that of a format, or in a hash.
  const std::string kind =
      job.kind == JobKind::kSurface ? "" : '.' + std::string(name_of(job.kind));
  return logs / (job.name + kind + ".log");
}

void remove_empty_logs(const fs::path& folder) {
  std::error_code ignored;
  for (const fs::directory_entry& log : fs::directory_iterator(folder, ignored))
    if (log.path().extension() == ".log" && log.file_size(ignored) == 0)
      fs::remove(log.path(), ignored);
}

std::vector<JobOutcome> run_jobs(const std::vector<PlannedJob>& plan,
                                 const JobParameters& parameters, const ExecutorOptions& options,
                                 Progress& progress, JobListener* listener) {
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
