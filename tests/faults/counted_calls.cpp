// A library for LD_PRELOAD. It counts calls of the C library that a program and its child processes
// make from main on, and makes one of them fail. Test programs in Python give the orders:
//   SEMIGEO_FAULTS_STATE  a file of at least kStateBytes, shared by all processes
//   SEMIGEO_FAULTS_FAIL   FUNCTION:N:ERRNO, the N-th call of that function, from 1; an errno of 0
//                         stands for half of the bytes
//   SEMIGEO_FAULTS_STACK  if it is set, a file to which the stack of the failing call is written
// It makes system calls directly, because it stands in the place of their functions.

#include "tests/faults/counted_calls.hpp"

#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace semigeo::faults {
namespace {

constexpr const char* kNames[kFunctions] = {
    "write",   "pwrite",    "fsync",  "rename",    "open",       "close", "read",  "pread",
    "mmap",    "ftruncate", "malloc", "pipe_read", "pipe_write", "stat",  "fstat", "lseek",
    "readdir", "mkdir",     "unlink", "link",      "pipe",       "fork",  "exec",  "thread",
    "poll",    "wait",      "dup",    "lock",      "socket",     "limit", "path",  "watch"};
constexpr std::size_t kStateBytes = 4096;
constexpr int kShort = 0;  // as an errno: half of the bytes
constexpr int kNone = -1;  // as an errno: the call is made as it is

struct State {
  std::atomic<std::uint64_t> calls[32];
  char failed[1024];  // the call that failed, as text
};
static_assert(sizeof(State) <= kStateBytes && kFunctions <= 32);

State* state = nullptr;  // nothing is counted before main
Function chosen = kFunctions;
std::uint64_t chosen_call = 0;
int chosen_error = kNone;

/// Notes which call fails.
void note(const char* what, int descriptor) {
  char path[512] = "";
  if (descriptor >= 0) {
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const long length = syscall(SYS_readlink, link, path, sizeof path - 1);
    path[length > 0 ? length : 0] = '\0';
  }
  std::snprintf(state->failed, sizeof state->failed, "process %d: %s%s", static_cast<int>(getpid()),
                what, path);
}

/// Writes the stack, for people who look for the cause of a finding.
void write_stack() {
  const char* path = std::getenv("SEMIGEO_FAULTS_STACK");
  if (path == nullptr) return;
  void* frames[64];
  const int depth = backtrace(frames, 64);
  const long file = syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0666);
  backtrace_symbols_fd(frames, depth, static_cast<int>(file));
  syscall(SYS_close, file);
}

/// Counts a call. Returns kNone, or how it fails.
int count(Function function, const char* what, int descriptor = -1) {
  if (state == nullptr) return kNone;
  const std::uint64_t call = ++state->calls[function];
  if (function != chosen || call != chosen_call) return kNone;
  const int before = errno;
  note(what, descriptor);
  write_stack();
  errno = before;
  return chosen_error;
}

using Main = int (*)(int, char**, char**);
Main program = nullptr;

/// Begins to count, and goes on with the program.
int counted_main(int argc, char** argv, char** environment) {
  const char* path = std::getenv("SEMIGEO_FAULTS_STATE");
  const long file = path == nullptr ? -1 : syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC);
  if (file < 0) return program(argc, argv, environment);
  void* memory = reinterpret_cast<void*>(
      syscall(SYS_mmap, nullptr, kStateBytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  syscall(SYS_close, file);
  if (memory == MAP_FAILED) return program(argc, argv, environment);
  char name[32] = "";
  unsigned long long call = 0;
  const char* order = std::getenv("SEMIGEO_FAULTS_FAIL");
  if (order != nullptr && std::sscanf(order, "%31[^:]:%llu:%d", name, &call, &chosen_error) == 3)
    for (int i = 0; i < kFunctions; ++i)
      if (std::strcmp(name, kNames[i]) == 0) chosen = static_cast<Function>(i);
  chosen_call = call;
  state = static_cast<State*>(memory);
  return program(argc, argv, environment);
}

}  // namespace

bool is_regular(int descriptor) {
  struct stat status {};
  const int before = errno;
  const bool regular = syscall(SYS_fstat, descriptor, &status) == 0 && S_ISREG(status.st_mode);
  errno = before;
  return regular;
}

ssize_t transfer(Function function, Function of_pipe, int descriptor, std::size_t bytes) {
  if (state == nullptr) return static_cast<ssize_t>(bytes);
  const int error = count(is_regular(descriptor) ? function : of_pipe, "", descriptor);
  if (error == kShort && bytes > 1) return static_cast<ssize_t>(bytes / 2);
  if (error <= 0) return static_cast<ssize_t>(bytes);
  errno = error;
  return -1;
}

bool fails(Function function, const char* what, int descriptor) {
  const int error = count(function, what, descriptor);
  if (error <= 0) return false;
  errno = error;
  return true;
}

bool counts() {
  return state != nullptr;
}

}  // namespace semigeo::faults

extern "C" int __libc_start_main(semigeo::faults::Main main, int argc, char** argv, void (*init)(),
                                 void (*fini)(), void (*rtld_fini)(), void* stack_end) {
  using namespace semigeo::faults;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program = main;
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}
