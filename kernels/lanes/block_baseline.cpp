#include <cstdint>

#include "kernels/lanes/patch_block.hpp"
#include "kernels/patch/geodesic_limits.hpp"

#include "kernels/lanes/vectors.inc"

namespace semigeo::kernels::baseline {

using namespace lanes;

#include "kernels/lanes/vectors_baseline.inc"

#include "kernels/lanes/geometry.inc"

#include "kernels/lanes/fans.inc"

#include "kernels/lanes/positions.inc"

#include "kernels/lanes/trace.inc"

#include "kernels/lanes/block.inc"

}  // namespace semigeo::kernels::baseline
