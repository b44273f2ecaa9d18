#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "engine/fork_child.hpp"
#include "engine/machine.hpp"
#include "engine/resources.hpp"
#include "io/files/error.hpp"

namespace semigeo::jobs {

/// Returns whether a child process has crashed, and not for lack of memory.
bool has_crashed(const engine::ForkedResult& result);

/// Calls `work(i)` for 0 <= i < count, each in a child process (engine::ForkedChild), because it
/// reads files that may make a library crash or loop. As many run side by side as `total` has cores
/// and memory for. `bytes(i)` is the memory that each is expected to need. One that needs more than
/// there is runs alone. `cpu_seconds(i)` limits the time of each. One that crashes is tried once
/// more: only damage crashes a library each time. Returns how each has ended, in order. Throws
/// std::system_error if there can be no child although none is running.
template <typename Work, typename Seconds, typename Bytes>
std::vector<engine::ForkedResult> in_children(std::size_t count, engine::Amount total,
                                              const Work& work, const Seconds& cpu_seconds,
                                              const Bytes& bytes) {
  engine::Resources resources(total);
  const auto amount = [&](std::size_t i) { return engine::Amount{.cores = 1, .bytes = bytes(i)}; };
  std::vector<engine::ForkedChild> children;
  std::vector<engine::ForkedResult> results;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t next; (next = children.size()) < count && resources.admit(amount(next));) {
      try {
        children.emplace_back([&work, next] { return std::string(work(next)); }, cpu_seconds(next));
      } catch (const std::system_error&) {
        if (next == i) throw;
        resources.release(amount(next));  // there may be a process when another has ended
        break;
      }
    }
    results.push_back(children[i].wait());
    if (has_crashed(results.back()))
      results.back() =
          engine::ForkedChild([&work, i] { return std::string(work(i)); }, cpu_seconds(i)).wait();
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

/// Returns whether a reader that did not come to its end says something about the file: it crashed,
/// again and again, or never ended. In all other cases the file may be whole.
bool tells_of_damage(const engine::ForkedResult& result);

/// What is said about a file that its reader says to be damaged.
struct DamageWords {
  const char* endless = "it is damaged so that HDF5 never ends reading it";
  const char* crash = "it is damaged so that HDF5 crashes over it";
  const char* remedy = "remove it and run again, or run with --verify";
};

/// Returns the error about a file whose reader in a child process did not come to its end.
io::Error unfinished_reading(const engine::ForkedResult& result, const std::filesystem::path& file,
                             const DamageWords& words = {});

}  // namespace semigeo::jobs
