#include "engine/lack_of_memory.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <new>

namespace semigeo::engine {
namespace {

// Sanitizers have handlers of their own, which say more about a crash.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

// Handlers may read nothing but such values.
const char* final_sentence = "";
int final_code = EXIT_FAILURE;
std::terminate_handler usual_end = nullptr;

[[noreturn]] void end_now() {
  // Nothing is left to do if this cannot be written.
  [[maybe_unused]] const ssize_t written =
      ::write(STDERR_FILENO, final_sentence, std::strlen(final_sentence));
  _exit(final_code);
}

[[noreturn]] void on_terminate() {
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      end_now();
    } catch (...) {
    }
  }
  if (usual_end != nullptr) usual_end();
  std::abort();
}

/// The last failed allocation has set errno, and little else does before a crash over it.
void on_crash(int number) {
  if (errno == ENOMEM) end_now();
  signal(number, SIG_DFL);
  raise(number);
}

/// HDF5 1.10 ends the process with -1 when an identifier gets no memory. Nothing else uses this
/// code.
void on_exit_of_library(int status, void*) {
  if (status == -1) end_now();
}

/// Lets handlers of this thread run when its stack is used up: without memory, HDF5 reports that it
/// cannot report an error, and so on.
void keep_stack_for_handlers() {
  alignas(16) static std::array<char, 1 << 16> stack;
  const stack_t kept = {.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
  sigaltstack(&kept, nullptr);
}

}  // namespace

void end_for_lack_of_memory(const char* sentence, int exit_code) {
  final_sentence = sentence;
  final_code = exit_code;
  const std::terminate_handler before = std::set_terminate(on_terminate);
  if (before != on_terminate) usual_end = before;
  [[maybe_unused]] static const int registered = ::on_exit(on_exit_of_library, nullptr);
  if constexpr (kSanitized) return;
  keep_stack_for_handlers();
  struct sigaction action = {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT}) sigaction(number, &action, nullptr);
}

}  // namespace semigeo::engine
