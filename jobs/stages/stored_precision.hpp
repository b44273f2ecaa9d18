#pragma once

#include "engine/parallel.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "kernels/features/features.hpp"

namespace semigeo::jobs {

/// How exact the numbers of a dataset are stored.
enum class Precision {
  kFull,  ///< As they were computed: 24 significant bits.
  kScan   ///< What lies below the noise of any scan is rounded away, so that it takes no room.
};

/// Positions are stored to this part of the level's step, or better.
inline constexpr double kPositionShare = 1e-3;
/// The largest error of a component of a unit vector.
inline constexpr float kNormalError = 1e-3f;
/// Significant bits of curvatures, torsion and other numbers of any size: the largest relative
/// error is 2^-14, 6.1e-5.
inline constexpr int kSignificantBits = 14;

/// Returns the power of two to whose multiples positions of a level are rounded: the largest that
/// is not above 2 * kPositionShare * step. Returns 0 if the step is not positive: nothing is
/// rounded.
float position_quantum(double step);

/// Rounds what is stored of a level as kScan says. `first_step` is the step of level 0, by which
/// the positions of features on level 0 are rounded. The vertices of level 0 (`first`) are those of
/// the scan and stay where they are. Numbers that are not finite stay as they are.
void round_to_scan(LevelFields& fields, kernels::LevelFeatures& features, double first_step,
                   bool first, engine::Workers& workers);

}  // namespace semigeo::jobs
