#include "engine/machine.hpp"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::engine {
namespace {

namespace fs = std::filesystem;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

int cores_of_affinity() {
  // Machines may have more than the CPU_SETSIZE (1024) of a plain cpu_set_t.
  std::vector<cpu_set_t> sets(64);
  const std::size_t bytes = sets.size() * sizeof(cpu_set_t);
  if (sched_getaffinity(0, bytes, sets.data()) != 0) return 1;
  return CPU_COUNT_S(bytes, sets.data());
}

/// Returns the number at the beginning of a file, or nothing if there is no file or it says "max".
std::optional<double> number_in(const fs::path& path) {
  std::ifstream file(path);
  double number;
  if (file >> number) return number;
  return {};
}

/// Returns the sum of the numbers behind these names in a file of lines "name number".
double named_numbers_in(const fs::path& path, const std::vector<std::string_view>& names) {
  std::ifstream file(path);
  double sum = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    double number;
    if (words >> name >> number && std::find(names.begin(), names.end(), name) != names.end())
      sum += number;
  }
  return sum;
}

/// Holds the folders that describe a control group and those around it, the innermost first.
struct GroupFolders {
  std::vector<fs::path> folders;
  bool version_2;
};

/// Returns the groups of this process for a controller, of version 1 or 2.
std::vector<GroupFolders> groups_of(const fs::path& root, const std::string& controller) {
  std::vector<GroupFolders> groups;
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {  // hierarchy:controllers:path
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool version_2 = controllers.empty();
    if (!version_2 && ("," + controllers + ",").find("," + controller + ",") == std::string::npos)
      continue;
    const fs::path mount = root / "sys/fs/cgroup" / (version_2 ? "" : controller);
    // Inside a container the path may be the one outside of it. Folders that do not exist are
    // passed over.
    GroupFolders group = {{}, version_2};
    for (fs::path path = line.substr(second + 1); path.has_relative_path();
         path = path.parent_path())
      group.folders.push_back(mount / path.relative_path());
    group.folders.push_back(mount);
    groups.push_back(std::move(group));
  }
  return groups;
}

/// Returns the number of cores that the quota of one group allows.
double quota_of(const fs::path& folder, bool version_2) {
  std::optional<double> quota, period;
  if (version_2) {  // "max 100000" or "150000 100000"
    std::ifstream file(folder / "cpu.max");
    double first, second;
    if (file >> first >> second) quota = first, period = second;
  } else {  // -1 = none
    quota = number_in(folder / "cpu.cfs_quota_us");
    period = number_in(folder / "cpu.cfs_period_us");
  }
  return quota && period && *quota > 0 && *period > 0 ? *quota / *period : kUnlimited;
}

/// Returns the bytes that one group has left. Cached files count as free.
double room_in(const fs::path& folder, bool version_2) {
  double limit = kUnlimited;
  const auto lower = [&](const char* name) {
    limit = std::min(limit, number_in(folder / name).value_or(kUnlimited));
  };
  if (version_2) {
    lower("memory.max");
    lower("memory.high");  // beyond it all processes become very slow
  } else {
    lower("memory.limit_in_bytes");  // a huge number = none
  }
  const double used =
      number_in(folder / (version_2 ? "memory.current" : "memory.usage_in_bytes")).value_or(0);
  const double cached = named_numbers_in(
      folder / "memory.stat",
      version_2 ? std::vector<std::string_view>{"inactive_file", "active_file"}
                : std::vector<std::string_view>{"total_inactive_file", "total_active_file"});
  return std::max(0.0, limit - std::max(0.0, used - cached));
}

template <class Measure>
double least(const fs::path& root, const std::string& controller, Measure measure) {
  double value = kUnlimited;
  for (const GroupFolders& group : groups_of(root, controller))
    for (const fs::path& folder : group.folders)
      value = std::min(value, measure(folder, group.version_2));
  return value;
}

}  // namespace

Amount usable_resources(const fs::path& root) {
  // The number is rounded up: one thread cannot use a quota of 1.5 cores.
  const double cores =
      std::min<double>(cores_of_affinity(), std::ceil(least(root, "cpu", quota_of)));
  const double available = 1024 * named_numbers_in(root / "proc/meminfo", {"MemAvailable:"});
  const double bytes = std::min(available, least(root, "memory", room_in));
  return {std::max(1, static_cast<int>(cores)), static_cast<std::uint64_t>(bytes)};
}

}  // namespace semigeo::engine
