#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace semigeo::jobs {

/// Names a process, its boot and its host. Unlike a process id, no two processes have the same.
struct ProcessIdentity {
  std::string host;
  std::string boot_id;  ///< Name of the boot; empty if the kernel does not tell it.
  pid_t pid = 0;
  std::uint64_t started = 0;  ///< Clock ticks since the boot; 0 if the kernel does not tell it.
  friend bool operator==(const ProcessIdentity&, const ProcessIdentity&) = default;
};

/// Returns the identity of the calling process.
ProcessIdentity this_process();

/// Says whether a process still runs, as far as that is known.
enum class Life { kAlive, kDead, kOnAnotherHost };

/// Returns whether the process still runs. A process that has ended, but for which its parent has
/// not waited yet, is dead. A process about which the kernel tells nothing is alive.
Life life_of(const ProcessIdentity& process);

}  // namespace semigeo::jobs
