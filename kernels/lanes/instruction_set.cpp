#include "kernels/lanes/instruction_set.hpp"

#include <algorithm>

namespace semigeo::kernels {

std::string_view name_of(InstructionSet set) {
  constexpr std::array<std::string_view, kInstructionSets.size()> names = {"scalar", "baseline",
                                                                           "avx2", "avx512"};
  return names[static_cast<std::size_t>(set)];
}

std::optional<InstructionSet> instruction_set_named(std::string_view name) {
  const auto* const found = std::find_if(kInstructionSets.begin(), kInstructionSets.end(),
                                         [&](InstructionSet set) { return name_of(set) == name; });
  if (found == kInstructionSets.end()) return std::nullopt;
  return *found;
}

bool supported(InstructionSet set) {
  switch (set) {
    case InstructionSet::kScalar:
    case InstructionSet::kBaseline:
      return true;
#if defined(__x86_64__)
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi") &&
             __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    case InstructionSet::kAvx512:
      return supported(InstructionSet::kAvx2) && __builtin_cpu_supports("avx512f") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512vl");
#else
    default:
      return false;
#endif
  }
  return false;
}

InstructionSet best_instruction_set() {
#if defined(__x86_64__)
  for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2})
    if (supported(set)) return set;
  return InstructionSet::kBaseline;
#else
  return InstructionSet::kScalar;  // lanes are not measured elsewhere
#endif
}

}  // namespace semigeo::kernels
