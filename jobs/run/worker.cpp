#include "jobs/run/worker.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "engine/descriptor.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/write_error.hpp"
#include "jobs/run/job_line.hpp"
#include "jobs/run/process_usage.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kReportInterval{250};
constexpr int kKeptMemory = 64 << 20;       // free bytes that the heap keeps from job to job
constexpr int kLeastOwnMapping = 32 << 20;  // larger allocations are given back at once

bool write_line(int descriptor, std::string line) {
  line += '\n';
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t written = write(descriptor, line.data() + at, line.size() - at);
    if (written < 0 && errno != EINTR) return false;
    at += static_cast<std::size_t>(std::max<ssize_t>(written, 0));
  }
  return true;
}

/// Reads lines from a descriptor.
class Lines {
 public:
  explicit Lines(int descriptor) : descriptor_(descriptor) {}

  bool next(std::string& line) {
    for (;;) {
      const std::size_t end = buffer_.find('\n');
      if (end != std::string::npos) {
        line = buffer_.substr(0, end);
        buffer_.erase(0, end + 1);
        return true;
      }
      char bytes[4096];
      const ssize_t count = read(descriptor_, bytes, sizeof bytes);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      buffer_.append(bytes, static_cast<std::size_t>(count));
    }
  }

 private:
  int descriptor_;
  std::string buffer_;
};

/// Reports from time to time how much work is done.
class Reporter : public engine::Observer {
 public:
  explicit Reporter(int answers) : answers_(answers) {}

  void worked(std::int64_t amount) override {
    const std::scoped_lock lock(mutex_);
    unreported_ += amount;
    const auto now = Clock::now();
    if (now - reported_ < kReportInterval) return;
    reported_ = now;
    write_line(answers_, to_line(JobReply{.kind = JobReply::Kind::kWorked,
                                          .worked = std::exchange(unreported_, 0)}));
  }
  std::int64_t unreported() const { return unreported_; }

 private:
  using Clock = std::chrono::steady_clock;
  int answers_;
  std::mutex mutex_;
  std::int64_t unreported_ = 0;
  Clock::time_point reported_ = Clock::now();
};

/// The file for standard output and standard error while a job runs. If nothing was printed, the
/// file is renamed for the next job: making and removing a file for each would take longer than
/// many jobs.
class JobLog {
 public:
  JobLog() = default;
  ~JobLog() {
    std::error_code ignored;
    if (file_) fs::remove(path_, ignored);
  }
  JobLog(const JobLog&) = delete;
  JobLog& operator=(const JobLog&) = delete;

  /// Redirects the output to the file. Does nothing if the path is empty or cannot be opened,
  /// because what a job prints is only for people.
  void begin(const fs::path& path) {
    if (path.empty() || (!take_over(path) && !open_anew(path))) return;
    std::fflush(nullptr);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      before_.emplace_back(fcntl(stream, F_DUPFD_CLOEXEC, 3));
      dup2(file_.get(), stream);
    }
  }

  void end() {
    if (before_.empty()) return;
    std::fflush(nullptr);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      dup2(before_[stream - STDOUT_FILENO].get(), stream);
    before_.clear();
    struct stat status = {};
    if (fstat(file_.get(), &status) != 0 || status.st_size != 0) file_ = {};
  }

 private:
  bool take_over(const fs::path& path) {
    if (!file_ || renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE) != 0)
      return false;
    path_ = path;
    return true;
  }

  bool open_anew(const fs::path& path) {
    std::error_code ignored;
    if (file_) fs::remove(path_, ignored);
    // Only the folder itself: an archive that is gone is not made again.
    fs::create_directory(path.parent_path(), ignored);
    file_ = engine::Descriptor(open(
        path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
    path_ = path;
    return static_cast<bool>(file_);
  }

  fs::path path_;
  engine::Descriptor file_;  ///< Not open, or empty between jobs.
  std::vector<engine::Descriptor> before_;
};

/// Limits the address space of this process to the given number of bytes; 0 stands for no limit.
/// Does nothing in a sanitized build, because the sanitizers reserve terabytes for themselves.
void limit_address_space([[maybe_unused]] std::uint64_t bytes) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) return;
  limit.rlim_cur = bytes == 0 ? limit.rlim_max : std::min<rlim_t>(bytes, limit.rlim_max);
  setrlimit(RLIMIT_AS, &limit);
#endif
}

/// Returns the fault that SEMIGEO_TEST_FAULTS names for this job, or an empty text.
std::string fault_of(const Job& job) {
  const std::string name = job.kind->words().stands_for_scan ? job.name : job_id(job);
  const char* faults = std::getenv("SEMIGEO_TEST_FAULTS");
  std::string_view rest = faults == nullptr ? "" : faults;
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    const std::size_t equals = one.find('=');
    if (equals != std::string_view::npos && one.substr(0, equals) == name)
      return std::string(one.substr(equals + 1));
  }
  return "";
}

void simulate_fault(const JobRequest& request) {
  const std::string fault = fault_of(request.job);
  if (fault.empty()) return;
  const fs::path mark = request.log.string() + ".once";
  if (fault == "crash" || (fault == "crash-once" && !fs::exists(mark))) {
    std::fprintf(stderr, "about to crash\n");
    if (fault == "crash-once") std::fclose(std::fopen(mark.c_str(), "w"));
    std::raise(SIGSEGV);
  }
  if (fault == "crash-once") fs::remove(mark);
  if (fault == "loop")
    for (volatile bool forever = true; forever;) {
    }
  if (fault == "sleep") pause();
  if (fault == "memory")
    for (std::vector<std::vector<char>> all;;) all.emplace_back(std::size_t{1} << 26, '1');
}

/// Restarts the measurement of the peak of memory.
void restart_peak() {
  std::ofstream("/proc/self/clear_refs") << '5';
}

/// Returns the peak of resident memory in bytes, or 0 if Linux does not tell it.
double peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return 1024 * kibibytes;
  }
  return 0;
}

JobReply do_job(const JobRequest& request, JobLog& log, Reporter& reporter) {
  JobReply reply;
  const double cpu_before = process_usage().cpu_seconds;
  restart_peak();
  try {
    log.begin(request.log);
    limit_address_space(request.address_space_bytes);
    simulate_fault(request);
    engine::Workers workers(request.threads);
    const JobKind& kind = *request.job.kind;
    reply.result =
        kind.result_to_json(kind.run(request.job, {{workers, reporter, {}}, request.memory_bytes}));
    reply.kind = JobReply::Kind::kDone;
  } catch (const std::bad_alloc&) {
    limit_address_space(0);
    reply.last = true;
    reply.error = subject_of(request.job).string() + ": needs more than the " +
                  std::to_string(request.address_space_bytes >> 20) +
                  " MiB of memory that a job may have; give --memory-per-job more" +
                  request.job.kind->words().memory_remedy;
  } catch (const io::WriteError& e) {
    reply.error = e.what();
    reply.write_error = e.code();
    reply.last = e.code() == ENOMEM;
  } catch (const io::ReadError& e) {
    reply.error = e.what();
    reply.last = e.code() == ENOMEM;
  } catch (const io::Error& e) {
    reply.error = e.what();
  } catch (
      const std::exception& e) {  // for example if there is no memory for the stack of a thread
    limit_address_space(0);
    reply.error = subject_of(request.job).string() + ": " + e.what() +
                  "; run again, or give --memory-per-job more if its " +
                  std::to_string(request.address_space_bytes >> 20) +
                  " MiB of memory were too little";
  }
  log.end();
  limit_address_space(0);
  const double peak = peak_bytes();
  // Free memory is given back, because the limit of the next job is added to what this process
  // holds. A little is kept, because that saves much time.
  if (mallinfo2().fordblks > std::size_t{kKeptMemory}) malloc_trim(0);
  reply.worked = reporter.unreported();
  reply.cpu_seconds = process_usage().cpu_seconds - cpu_before;
  reply.peak_bytes = peak;
  return reply;
}

}  // namespace

int serve_jobs(int requests, int answers, const JobKinds& kinds) {
  Lines lines(requests);
  // The system gives memory as zeroed pages, each with a page fault. So freed memory is kept for
  // the next use.
  mallopt(M_MMAP_THRESHOLD, kLeastOwnMapping);
  mallopt(M_TRIM_THRESHOLD, kKeptMemory);
  JobLog log;
  std::string line;
  while (lines.next(line)) {
    JobRequest request;
    try {
      request = job_request_from(line, kinds);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "semigeo: a line %s\n", e.what());
      return 2;
    }
    Reporter reporter(answers);
    const JobReply reply = do_job(request, log, reporter);
    if (!write_line(answers, to_line(reply))) return 0;  // the reader has ended
    if (reply.last) return 0;
  }
  return 0;
}

}  // namespace semigeo::jobs
