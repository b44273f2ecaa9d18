#include "jobs/archive/in_children.hpp"

#include <csignal>

namespace semigeo::jobs {

io::Error unfinished_reading(const engine::ForkedResult& result,
                             const std::filesystem::path& file) {
  if (result.signal == SIGKILL)
    return {file, "",
            "was not read to its end: the process that read it was killed, by hand or because "
            "memory ran out",
            "free some memory, and run again"};
  return {file, "",
          result.signal == SIGXCPU ? "it is damaged so that HDF5 never ends reading it"
                                   : "it is damaged so that HDF5 crashes over it",
          "remove it and run again, or run with --verify"};
}

}  // namespace semigeo::jobs
