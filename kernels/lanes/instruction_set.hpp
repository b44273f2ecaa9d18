#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace semigeo::kernels {

/// Names the ways in which patches can be traced. All give the same bytes.
enum class InstructionSet : std::uint8_t {
  kScalar,    ///< One vertex after the other; the definition of all results.
  kBaseline,  ///< 4 lanes, on every CPU that the program runs on.
  kAvx2,      ///< 8 lanes.
  kAvx512     ///< 16 lanes.
};

inline constexpr std::array kInstructionSets = {InstructionSet::kScalar, InstructionSet::kBaseline,
                                                InstructionSet::kAvx2, InstructionSet::kAvx512};

/// Returns the name as users write it: scalar, baseline, avx2 or avx512.
std::string_view name_of(InstructionSet set);
/// Returns the instruction set with that name, or nothing.
std::optional<InstructionSet> instruction_set_named(std::string_view name);
/// Tells whether this program has code for it and this CPU and operating system can run it.
bool supported(InstructionSet set);
/// Returns the fastest one that is supported.
InstructionSet best_instruction_set();

}  // namespace semigeo::kernels
