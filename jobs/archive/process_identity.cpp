#include "jobs/archive/process_identity.hpp"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <sstream>

#include "io/files/atomic_file.hpp"

namespace semigeo::jobs {
namespace {

std::string boot_id() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string id;
  std::getline(file, id);
  return id;
}

/// The status of a process as /proc tells it.
struct Status {
  char state = '\0';  ///< '\0' if /proc has no such process.
  std::uint64_t started = 0;
};

Status status_of(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  // The second field is the program's name in parentheses, and may itself hold any of them.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return {};
  constexpr int kFieldsBetween = 18;  // from the state, the third, to the start, the 22nd
  std::istringstream fields(text.substr(name_end + 1));
  Status status;
  std::string skipped;
  fields >> status.state;
  for (int i = 0; i < kFieldsBetween; ++i) fields >> skipped;
  fields >> status.started;
  return fields ? status : Status{};
}

}  // namespace

ProcessIdentity this_process() {
  const pid_t pid = getpid();
  return {io::host_name(), boot_id(), pid, status_of(pid).started};
}

Life life_of(const ProcessIdentity& process) {
  if (process.host != io::host_name()) return Life::kOnAnotherHost;
  const std::string boot = boot_id();
  if (!process.boot_id.empty() && !boot.empty() && process.boot_id != boot) return Life::kDead;
  if (process.pid <= 0 || (kill(process.pid, 0) != 0 && errno == ESRCH)) return Life::kDead;
  const Status status = status_of(process.pid);
  if (status.state == '\0') return Life::kAlive;  // /proc may hide the processes of other users
  const bool ended = status.state == 'Z' || status.state == 'X';
  const bool another = process.started != 0 && status.started != process.started;
  return ended || another ? Life::kDead : Life::kAlive;
}

}  // namespace semigeo::jobs
