#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

#include "engine/descriptor.hpp"

namespace semigeo::engine {

/// Tells how a child process ended that ran a function, and what the function returned.
struct ForkedResult {
  std::string text;  ///< All that the function returned, if it came to its end.
  /// 0 if the function came to its end; kNoMemoryCode (engine/lack_of_memory.hpp) if the child got
  /// no memory; -1 if a signal ended it.
  int exit_code = -1;
  int signal = 0;  ///< 0 if the child ended by itself.
};

/// A copy of this process that runs one function: for what may crash, or may never end, and must
/// take nothing else with it. The child has one thread, the caller's; whatever other threads held
/// when it was made, such as the lock of a library, stays held in it for ever.
class ForkedChild {
 public:
  /// Starts the child, which calls `work` and hands over the text that it returns. The child is
  /// killed by SIGXCPU when it has used `cpu_seconds` (0 = no limit; other values are rounded
  /// up to whole seconds), and when the calling thread ends. An exception that leaves `work` is a
  /// crash, but std::bad_alloc and a crash just after a failed allocation are ends with
  /// kNoMemoryCode. Its standard error is dropped, and it dumps no core. Throws std::system_error
  /// if there can be no child. The cost grows with the memory that this process uses, about 6 ms
  /// for each GB.
  ForkedChild(const std::function<std::string()>& work, double cpu_seconds);
  /// Kills the child if nobody has waited for it.
  ~ForkedChild();
  ForkedChild(ForkedChild&& other) noexcept;
  ForkedChild& operator=(ForkedChild&& other) = delete;

  /// Waits until the child has ended. It must be called only once.
  ForkedResult wait();

 private:
  pid_t process_ = -1;  ///< -1 once it has been waited for.
  Descriptor answer_;
};

}  // namespace semigeo::engine
