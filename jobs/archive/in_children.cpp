#include "jobs/archive/in_children.hpp"

#include <cerrno>
#include <csignal>

#include "engine/lack_of_memory.hpp"
#include "io/files/read_error.hpp"

namespace semigeo::jobs {

bool has_crashed(const engine::ForkedResult& result) {
  return result.signal == SIGSEGV || result.signal == SIGBUS || result.signal == SIGABRT ||
         result.signal == SIGFPE || result.signal == SIGILL;
}

bool tells_of_damage(const engine::ForkedResult& result) {
  return has_crashed(result) || result.signal == SIGXCPU;
}

io::Error unfinished_reading(const engine::ForkedResult& result, const std::filesystem::path& file,
                             const DamageWords& words) {
  if (result.exit_code == engine::kNoMemoryCode)
    return io::ReadError(ENOMEM, file, "", "was not read to its end: there was no memory for it");
  if (result.signal == SIGKILL)
    return {file, "",
            "was not read to its end: the process that read it was killed, by hand or because "
            "memory ran out",
            "free some memory, and run again"};
  if (!tells_of_damage(result)) {
    const std::string end = result.signal != 0
                                ? "was ended by signal " + std::to_string(result.signal)
                                : "ended with exit code " + std::to_string(result.exit_code);
    return {file, "", "was not read to its end: the process that read it " + end,
            "the file itself may be whole: run again"};
  }
  return {file, "", result.signal == SIGXCPU ? words.endless : words.crash, words.remedy};
}

}  // namespace semigeo::jobs
