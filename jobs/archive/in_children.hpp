#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/fork_child.hpp"
#include "engine/machine.hpp"
#include "io/files/error.hpp"

namespace semigeo::jobs {

/// Calls `work(i)` for 0 <= i < count, each in a child process (engine::ForkedChild), `at_once` of
/// them at a time (0: one for each core), because it reads files that may make a library crash or
/// loop. `cpu_seconds(i)` limits the time of each. Returns how each has ended, in order.
template <typename Work, typename Seconds>
std::vector<engine::ForkedResult> in_children(std::size_t count, int at_once, const Work& work,
                                              const Seconds& cpu_seconds) {
  const auto most =
      static_cast<std::size_t>(at_once > 0 ? at_once : engine::usable_resources().cores);
  std::vector<engine::ForkedChild> children;
  std::vector<engine::ForkedResult> results;
  for (std::size_t i = 0; i < count; ++i) {
    while (children.size() < std::min(i + most, count)) {
      const std::size_t next = children.size();
      children.emplace_back([&work, next] { return std::string(work(next)); }, cpu_seconds(next));
    }
    results.push_back(children[i].wait());
  }
  return results;
}

/// Returns the error about a file whose reader in a child process did not come to its end.
io::Error unfinished_reading(const engine::ForkedResult& result, const std::filesystem::path& file);

}  // namespace semigeo::jobs
