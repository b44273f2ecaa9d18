#include "engine/lack_of_memory.hpp"

#include <signal.h>
#include <unistd.h>

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

}  // namespace

void end_for_lack_of_memory(const char* sentence, int exit_code) {
  final_sentence = sentence;
  final_code = exit_code;
  const std::terminate_handler before = std::set_terminate(on_terminate);
  if (before != on_terminate) usual_end = before;
  if constexpr (kSanitized) return;
  struct sigaction action = {};
  action.sa_handler = on_crash;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT}) sigaction(number, &action, nullptr);
}

}  // namespace semigeo::engine
