#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/fork_child.hpp"
#include "engine/machine.hpp"
#include "engine/resources.hpp"
#include "io/files/error.hpp"

namespace semigeo::jobs {

/// Calls `work(i)` for 0 <= i < count, each in a child process (engine::ForkedChild), because it
/// reads files that may make a library crash or loop. As many run side by side as `total` has cores
/// and memory for. `bytes(i)` is the memory that each is expected to need. One that needs more than
/// there is runs alone. `cpu_seconds(i)` limits the time of each. Returns how each has ended, in
/// order.
template <typename Work, typename Seconds, typename Bytes>
std::vector<engine::ForkedResult> in_children(std::size_t count, engine::Amount total,
                                              const Work& work, const Seconds& cpu_seconds,
                                              const Bytes& bytes) {
  engine::Resources resources(total);
  const auto amount = [&](std::size_t i) { return engine::Amount{.cores = 1, .bytes = bytes(i)}; };
  std::vector<engine::ForkedChild> children;
  std::vector<engine::ForkedResult> results;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t next; (next = children.size()) < count && resources.admit(amount(next));)
      children.emplace_back([&work, next] { return std::string(work(next)); }, cpu_seconds(next));
    results.push_back(children[i].wait());
    resources.release(amount(i));
  }
  return results;
}

/// Does the same with work that needs little memory, `at_once` pieces of it at a time (0: one for
/// each core).
template <typename Work, typename Seconds>
std::vector<engine::ForkedResult> in_children(std::size_t count, int at_once, const Work& work,
                                              const Seconds& cpu_seconds) {
  const int cores = at_once > 0 ? at_once : engine::usable_resources().cores;
  return in_children(count, {.cores = cores}, work, cpu_seconds,
                     [](std::size_t) { return std::uint64_t{0}; });
}

/// Returns the error about a file whose reader in a child process did not come to its end.
io::Error unfinished_reading(const engine::ForkedResult& result, const std::filesystem::path& file);

}  // namespace semigeo::jobs
