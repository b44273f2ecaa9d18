#pragma once

#include <dlfcn.h>
#include <sys/types.h>

#include <cstddef>

namespace semigeo::faults {

// Functions of the same name and effect are one. Calls with a descriptor that is no regular file,
// which mostly is a pipe, are counted apart.
enum Function {
  kWrite,
  kPwrite,
  kFsync,
  kRename,
  kOpen,
  kClose,
  kRead,
  kPread,
  kMmap,
  kFtruncate,
  kMalloc,
  kPipeRead,
  kPipeWrite,
  kStat,
  kFstat,
  kSeek,
  kReaddir,
  kMkdir,
  kUnlink,
  kLink,
  kPipe,
  kFork,
  kExec,
  kThread,
  kPoll,
  kWait,
  kDup,
  kLock,
  kSocket,
  kLimit,
  kPath,
  kWatch,
  kFunctions
};
/// Counts a call that moves bytes. Returns how many are to be moved, or -1 with errno. A descriptor
/// that is no regular file counts as `of_pipe`.
ssize_t transfer(Function function, Function of_pipe, int descriptor, std::size_t bytes);

/// Counts any other call. Returns whether it fails, with errno. `what` and the file behind the
/// descriptor name it.
bool fails(Function function, const char* what, int descriptor = -1);

/// Returns whether a descriptor is one of a regular file. Leaves errno alone.
bool is_regular(int descriptor);

/// Returns whether calls are counted, which they are from main on.
bool counts();

/// Returns the function of the C library that stands behind one of this library.
template <typename Signature>
Signature* behind(Signature*, const char* name) {
  return reinterpret_cast<Signature*>(dlsym(RTLD_NEXT, name));
}

}  // namespace semigeo::faults
