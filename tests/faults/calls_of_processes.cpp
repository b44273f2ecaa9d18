// Calls that concern processes, threads, pipes and memory. System calls are made directly, because
// these functions stand in the place of those that make them.

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>

#include "tests/faults/counted_calls.hpp"

extern "C" {
void* __libc_malloc(std::size_t bytes);
void* __libc_calloc(std::size_t count, std::size_t bytes);
void* __libc_realloc(void* memory, std::size_t bytes);
void* __libc_memalign(std::size_t alignment, std::size_t bytes);
}

using namespace semigeo::faults;

namespace {

// A child of vfork must not look for it.
const auto real_execv = behind(&execv, "execv");

}  // namespace

extern "C" {

int pipe2(int* ends, int flags) noexcept {
  return fails(kPipe, "pipe") ? -1 : static_cast<int>(syscall(SYS_pipe2, ends, flags));
}

int socketpair(int domain, int type, int protocol, int* ends) noexcept {
  if (fails(kPipe, "socketpair")) return -1;
  return static_cast<int>(syscall(SYS_socketpair, domain, type, protocol, ends));
}

int eventfd(unsigned int value, int flags) noexcept {
  return fails(kPipe, "eventfd") ? -1 : static_cast<int>(syscall(SYS_eventfd2, value, flags));
}

pid_t fork() noexcept {
  if (fails(kFork, "fork")) return -1;
  static const auto next = behind(&fork, "fork");
  return next();
}

int execv(const char* path, char* const* arguments) noexcept {
  return fails(kExec, path) ? -1 : real_execv(path, arguments);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*begin)(void*),
                   void* argument) noexcept {
  if (fails(kThread, "thread")) return errno;
  static const auto next = behind(&pthread_create, "pthread_create");
  return next(thread, attributes, begin, argument);
}

int poll(pollfd* watched, nfds_t count, int timeout) {
  if (fails(kPoll, "poll")) return -1;
  return static_cast<int>(syscall(SYS_poll, watched, count, timeout));
}

int ppoll(pollfd* watched, nfds_t count, const timespec* timeout, const sigset_t* signals) {
  if (fails(kPoll, "ppoll")) return -1;
  static const auto next = behind(&ppoll, "ppoll");
  return next(watched, count, timeout, signals);
}

pid_t wait4(pid_t process, int* status, int options, rusage* usage) noexcept {
  if (fails(kWait, "wait")) return -1;
  return static_cast<pid_t>(syscall(SYS_wait4, process, status, options, usage));
}

pid_t waitpid(pid_t process, int* status, int options) {
  return wait4(process, status, options, nullptr);
}

int dup2(int from, int to) noexcept {
  return fails(kDup, "", from) ? -1 : static_cast<int>(syscall(SYS_dup2, from, to));
}

int fcntl64(int descriptor, int command, ...) {
  va_list rest;
  va_start(rest, command);
  const long argument = va_arg(rest, long);
  va_end(rest);
  const bool copies = command == F_DUPFD || command == F_DUPFD_CLOEXEC;
  if (copies && fails(kDup, "", descriptor)) return -1;
  const bool locks = command == F_SETLK || command == F_SETLKW || command == F_OFD_SETLK;
  if (locks && fails(kLock, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_fcntl, descriptor, command, argument));
}

int fcntl(int descriptor, int command, ...) {
  va_list rest;
  va_start(rest, command);
  const long argument = va_arg(rest, long);
  va_end(rest);
  return fcntl64(descriptor, command, argument);
}

int flock(int descriptor, int operation) noexcept {
  if (fails(kLock, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_flock, descriptor, operation));
}

ssize_t send(int descriptor, const void* bytes, std::size_t size, int flags) {
  const ssize_t moved = transfer(kSocket, kSocket, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_sendto, descriptor, bytes, moved, flags, nullptr, 0);
}

ssize_t recv(int descriptor, void* bytes, std::size_t size, int flags) {
  const ssize_t moved = transfer(kSocket, kSocket, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_recvfrom, descriptor, bytes, moved, flags, nullptr, nullptr);
}

int setrlimit(__rlimit_resource_t resource, const rlimit* limit) noexcept {
  if (fails(kLimit, "setrlimit")) return -1;
  return static_cast<int>(syscall(SYS_prlimit64, 0, resource, limit, nullptr));
}

int prlimit(pid_t process, __rlimit_resource resource, const rlimit* limit,
            rlimit* before) noexcept {
  if (fails(kLimit, "prlimit")) return -1;
  return static_cast<int>(syscall(SYS_prlimit64, process, resource, limit, before));
}

/// Makes a system call. It is used here, too.
long syscall(long number, ...) noexcept {
  va_list rest;
  va_start(rest, number);
  long a[6];
  for (long& argument : a) argument = va_arg(rest, long);
  va_end(rest);
  if (number == SYS_pidfd_open && fails(kWatch, "pidfd_open")) return -1;
  long result;
  register long r10 asm("r10") = a[3];
  register long r8 asm("r8") = a[4];
  register long r9 asm("r9") = a[5];
  asm volatile("syscall"
               : "=a"(result)
               : "a"(number), "D"(a[0]), "S"(a[1]), "d"(a[2]), "r"(r10), "r"(r8), "r"(r9)
               : "rcx", "r11", "memory");
  if (result >= 0 || result < -4095) return result;
  errno = static_cast<int>(-result);
  return -1;
}

/// Returns whether vfork is to fail.
__attribute__((visibility("hidden"))) bool vfork_fails() {
  return fails(kFork, "vfork");
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

// The child of vfork returns on the stack of its parent, so no frame may stand in between.
asm(R"(
  .globl vfork
  .type vfork, @function
vfork:
  subq $8, %rsp
  call vfork_fails
  addq $8, %rsp
  testb %al, %al
  jnz 1f
  popq %rdi
  movl $58, %eax
  syscall
  pushq %rdi
  testl %eax, %eax
  js 1f
  ret
1:
  movl $-1, %eax
  ret
  .size vfork, . - vfork
)");
