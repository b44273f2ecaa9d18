#pragma once

#include <cstdint>
#include <span>

#include "kernels/evolution/evolution.hpp"
#include "kernels/lanes/instruction_set.hpp"

namespace semigeo::kernels {

/// Does for many vertices at once what `evolve_vertex` does for one, several times as fast: result
/// i is that of the origin of half-edge `first[i]`, which is also the first edge of its patch
/// (`layout.first` is not used). Results are the same, byte by byte, for every instruction set,
/// which must be supported. Neighbours in `first` should be neighbours in space. Each thread that
/// calls it keeps about 200 kB of memory. Returns how many vertices were left to `evolve_vertex`:
/// rare cases that lanes do not trace, or all of them for scalar code. Source: thesis 5.2 - 5.6.
std::int64_t evolve_vertices(const SampledSurface& surface, std::span<const std::int32_t> first,
                             const PatchLayout& layout, InstructionSet set,
                             std::span<EvolvedVertex> results);

}  // namespace semigeo::kernels
