#include "jobs/stages/chosen_instruction_set.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace semigeo::jobs {

std::string supported_instruction_sets() {
  std::string names;
  for (const kernels::InstructionSet set : kernels::kInstructionSets)
    if (supported(set)) names += (names.empty() ? "" : ", ") + std::string(name_of(set));
  return names;
}

kernels::InstructionSet chosen_instruction_set() {
  const char* const name = std::getenv("SEMIGEO_SIMD");
  if (name == nullptr || *name == '\0') return kernels::best_instruction_set();
  const auto set = kernels::instruction_set_named(name);
  if (set && supported(*set)) return *set;
  throw std::invalid_argument("SEMIGEO_SIMD=" + std::string(name) + ": " +
                              (set ? "this CPU does not have it" : "no such instruction set") +
                              "; give one of " + supported_instruction_sets() + ", or unset it");
}

}  // namespace semigeo::jobs
