// A library for LD_PRELOAD. It counts calls of the C library that a program and its child processes
// make from main on, and makes one of them fail. Test programs in Python give the orders:
//   SEMIGEO_FAULTS_STATE  a file of at least kStateBytes, shared by all processes
//   SEMIGEO_FAULTS_FAIL   FUNCTION:N:ERRNO, the N-th call of that function, from 1; an errno of 0
//                         stands for half of the bytes
//   SEMIGEO_FAULTS_STACK  if it is set, a file to which the stack of the failing call is written
// It makes system calls directly, because it stands in the place of their functions.

#include <dirent.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

namespace {

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
  kFunctions
};
constexpr const char* kNames[kFunctions] = {
    "write", "pwrite", "fsync",     "rename", "open",      "close",     "read",
    "pread", "mmap",   "ftruncate", "malloc", "pipe_read", "pipe_write"};
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

bool is_regular(int descriptor) {
  struct stat status {};
  const int before = errno;
  const bool regular = syscall(SYS_fstat, descriptor, &status) == 0 && S_ISREG(status.st_mode);
  errno = before;
  return regular;
}

/// Counts a call that moves bytes. Returns how many are to be moved, or -1 with errno.
ssize_t transfer(Function function, Function of_pipe, int descriptor, std::size_t bytes) {
  if (state == nullptr) return static_cast<ssize_t>(bytes);
  const int error = count(is_regular(descriptor) ? function : of_pipe, "", descriptor);
  if (error == kShort && bytes > 1) return static_cast<ssize_t>(bytes / 2);
  if (error <= 0) return static_cast<ssize_t>(bytes);
  errno = error;
  return -1;
}

/// Counts any other call. Returns whether it fails, with errno.
bool fails(Function function, const char* what, int descriptor = -1) {
  const int error = count(function, what, descriptor);
  if (error <= 0) return false;
  errno = error;
  return true;
}

int open_at(int folder, const char* path, int flags, mode_t mode) {
  if (fails(kOpen, path)) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_of(int flags, va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
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

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  program = main;
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  const ssize_t moved = transfer(kWrite, kPipeWrite, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_write, descriptor, bytes, moved);
}

ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off64_t offset) {
  const ssize_t moved = transfer(kPwrite, kPwrite, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_pwrite64, descriptor, bytes, moved, offset);
}

ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t offset) {
  return pwrite64(descriptor, bytes, size, offset);
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  const ssize_t moved = transfer(kRead, kPipeRead, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_read, descriptor, bytes, moved);
}

ssize_t pread64(int descriptor, void* bytes, std::size_t size, off64_t offset) {
  const ssize_t moved = transfer(kPread, kPread, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_pread64, descriptor, bytes, moved, offset);
}

ssize_t pread(int descriptor, void* bytes, std::size_t size, off_t offset) {
  return pread64(descriptor, bytes, size, offset);
}

int fsync(int descriptor) {
  return fails(kFsync, "", descriptor) ? -1 : static_cast<int>(syscall(SYS_fsync, descriptor));
}

int fdatasync(int descriptor) {
  return fails(kFsync, "", descriptor) ? -1 : static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

int rename(const char* from, const char* to) {
  return fails(kRename, to) ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned int flags) noexcept {
  if (fails(kRename, to)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(AT_FDCWD, path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(AT_FDCWD, path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(folder, path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(folder, path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (fails(kOpen, path)) return nullptr;
  static const auto next = reinterpret_cast<decltype(&fopen)>(dlsym(RTLD_NEXT, "fopen64"));
  return next(path, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return fopen64(path, mode);
}

DIR* opendir(const char* path) {
  if (fails(kOpen, path)) return nullptr;
  static const auto next = reinterpret_cast<decltype(&opendir)>(dlsym(RTLD_NEXT, "opendir"));
  return next(path);
}

/// The descriptor is closed even if the call fails, as by Linux.
int close(int descriptor) {
  const bool failed = state != nullptr && is_regular(descriptor) && fails(kClose, "", descriptor);
  const int error = errno;
  const int result = static_cast<int>(syscall(SYS_close, descriptor));
  if (!failed) return result;
  errno = error;
  return -1;
}

void* mmap64(void* at, std::size_t size, int access, int flags, int descriptor, off64_t offset) {
  if (fails(kMmap, "", descriptor)) return MAP_FAILED;
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, access, flags, descriptor, offset));
}

void* mmap(void* at, std::size_t size, int access, int flags, int descriptor, off_t offset) {
  return mmap64(at, size, access, flags, descriptor, offset);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  if (fails(kFtruncate, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}

int ftruncate(int descriptor, off_t size) noexcept {
  return ftruncate64(descriptor, size);
}

void* malloc(std::size_t bytes) {
  return fails(kMalloc, "malloc") ? nullptr : __libc_malloc(bytes);
}

void* calloc(std::size_t number, std::size_t bytes) {
  return fails(kMalloc, "calloc") ? nullptr : __libc_calloc(number, bytes);
}

void* realloc(void* memory, std::size_t bytes) {
  return fails(kMalloc, "realloc") ? nullptr : __libc_realloc(memory, bytes);
}

void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  return fails(kMalloc, "aligned_alloc") ? nullptr : __libc_memalign(alignment, bytes);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t bytes) {
  if (fails(kMalloc, "posix_memalign")) return ENOMEM;
  *memory = __libc_memalign(alignment, bytes);
  return *memory == nullptr ? ENOMEM : 0;
}

}  // extern "C"
