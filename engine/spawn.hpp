#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/descriptor.hpp"

namespace semigeo::engine {

/// The descriptor on which a child answers, besides its descriptors 0 to 2.
inline constexpr int kAnswersDescriptor = 3;

/// Describes what `spawn` starts. The descriptors belong to the caller and may have any numbers.
struct Program {
  const std::vector<std::string>& arguments;  ///< [0] is the path of the program.
  int input;                                  ///< Becomes descriptor 0.
  int output;                                 ///< Becomes descriptors 1 and 2.
  int answers;                        ///< Becomes descriptor 3; -1 = there is no such descriptor.
  std::uint64_t address_space_bytes;  ///< 0 = as much as this process may have.
  double cpu_seconds;                 ///< 0 = as much as this process may have.
  /// Variables "NAME=value" that the program gets besides those of this process, which stay as they
  /// are if they have the same name.
  std::vector<std::string> environment = {};
};

/// Starts a program in a process of its own, which
/// - leads a process group of its own, so that a terminal's Ctrl-C is not for it;
/// - is killed when the calling *thread* ends, however that ends;
/// - has the descriptors above and no others, every signal at its default and none blocked;
/// - dumps no core.
/// Returns when the program runs; the caller must wait for the process. Throws std::system_error
/// when it cannot be started, with the program's path. The cost does not depend on how much memory
/// this process uses.
pid_t spawn(const Program& program);

/// Returns a descriptor that is readable when the process has ended, whoever its parent is. Throws
/// std::system_error.
Descriptor watch(pid_t process);

/// Lets the process get SIGXCPU when it has used this number of CPU seconds since its start,
/// rounded up to whole ones. 0 means as many as it may have. Throws std::system_error.
void limit_cpu_time(pid_t process, double seconds);

}  // namespace semigeo::engine
