#include "jobs/cli/version.hpp"

#include "jobs/stages/chosen_instruction_set.hpp"

namespace semigeo::jobs::cli {

std::string build_text() {
  return SEMIGEO_BUILD;
}

std::string version_text() {
  return std::string(SEMIGEO_VERSION) + "\ncommit: " + kCommit + "\nbuild: " + build_text() +
         "\nsimd: " + std::string(kernels::name_of(chosen_instruction_set())) + " (this CPU has " +
         supported_instruction_sets() + ")";
}

}  // namespace semigeo::jobs::cli
