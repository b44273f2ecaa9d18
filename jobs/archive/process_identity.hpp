#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

namespace semigeo::jobs {

/// Which process of which boot of which host: unlike a process id, never given twice.
struct ProcessIdentity {
  std::string host;
  std::string boot_id;  ///< of the kernel; empty where it does not tell
  pid_t pid = 0;
  std::uint64_t started = 0;  ///< clock ticks since the boot; 0 where the kernel does not tell
  friend bool operator==(const ProcessIdentity&, const ProcessIdentity&) = default;
};

ProcessIdentity this_process();

enum class Life { kAlive, kDead, kOnAnotherHost };

/// Whether the process still runs. One that ended but whose parent has not asked about it yet is
/// dead; one that cannot be looked at is alive.
Life life_of(const ProcessIdentity& process);

}  // namespace semigeo::jobs
