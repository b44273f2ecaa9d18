#include "jobs/bench/machine.hpp"

#include <sys/utsname.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <utility>

#include "engine/machine.hpp"
#include "io/files/atomic_file.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Returns what stands behind "model name" in /proc/cpuinfo, or "unknown".
std::string processor_name(const fs::path& root) {
  std::ifstream file(root / "proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

/// Returns the kind of the file system that has this folder.
std::string file_system_of(const fs::path& folder) {
  constexpr std::array<std::pair<unsigned long, const char*>, 7> kKinds = {{
      {0xEF53, "ext"},
      {0x01021994, "tmpfs"},
      {0x794C7630, "overlay"},
      {0x58465342, "xfs"},
      {0x9123683E, "btrfs"},
      {0x6969, "nfs"},
      {0x2FC12FC1, "zfs"},
  }};
  struct statfs information {};
  if (statfs(folder.c_str(), &information) != 0) return "unknown";
  for (const auto& [magic, name] : kKinds)
    if (static_cast<unsigned long>(information.f_type) == magic) return name;
  return "unknown";
}

}  // namespace

MachineDescription describe_machine(const fs::path& temporary_folder, const fs::path& root) {
  const engine::Amount usable = engine::usable_resources(root);
  utsname kernel{};
  uname(&kernel);
  return {.host = io::host_name(),
          .processor = processor_name(root),
          .machine_cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)),
          .usable_cores = usable.cores,
          .usable_bytes = usable.bytes,
          .system = std::string(kernel.sysname) + " " + kernel.release,
          .temporary_folder = temporary_folder.parent_path().string(),
          .file_system = file_system_of(temporary_folder)};
}

MachineTimes machine_times(const fs::path& root) {
  std::ifstream file(root / "proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, soft_irq = 0, stolen = 0;
  file >> name >> user >> nice >> system >> idle >> waiting >> irq >> soft_irq >> stolen;
  if (!file || name != "cpu") return {};
  const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  return {.busy = (user + nice + system + irq + soft_irq) / ticks, .stolen = stolen / ticks};
}

std::optional<double> seconds_in_queue(const fs::path& root) {
  std::optional<double> seconds;
  std::error_code error;
  for (fs::directory_iterator task(root / "proc/self/task", error), end; !error && task != end;
       task.increment(error)) {
    std::ifstream file(task->path() / "schedstat");
    double run = 0, waited = 0;  // in nanoseconds
    if (file >> run >> waited) seconds = seconds.value_or(0) + 1e-9 * waited;
  }
  return seconds;
}

double load_average(const fs::path& root) {
  std::ifstream file(root / "proc/loadavg");
  double load = 0;
  return file >> load ? load : 0;
}

}  // namespace semigeo::jobs
