#pragma once

#include <string>

#include "kernels/lanes/instruction_set.hpp"

namespace semigeo::jobs {

/// Returns the instruction set that the environment variable SEMIGEO_SIMD names (scalar, baseline,
/// avx2 or avx512), or the fastest one that this CPU has. Results do not depend on it. Throws
/// `std::invalid_argument` if the name is unknown or this CPU does not have it.
kernels::InstructionSet chosen_instruction_set();

/// Returns the names of the instruction sets that this CPU has, with commas between them.
std::string supported_instruction_sets();

}  // namespace semigeo::jobs
