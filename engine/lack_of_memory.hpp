#pragma once

namespace semigeo::engine {

/// The exit code of a child process that has ended because it got no memory.
inline constexpr int kNoMemoryCode = 71;

/// Makes a lack of memory that nothing else handles an end of this process with `exit_code`, after
/// `sentence` on standard error. It does so if std::bad_alloc leaves a function that must not
/// throw, if the process crashes or uses up the stack of this thread just after an allocation has
/// failed, and if a library ends it with -1: some libraries do that, or go on, without the memory.
/// Any other crash stays a crash. The last call counts, also in a process that is forked. The text
/// of `sentence` must live as long as the process. In a build with sanitizers, which have handlers
/// of their own, crashes are left alone.
void end_for_lack_of_memory(const char* sentence, int exit_code);

}  // namespace semigeo::engine
