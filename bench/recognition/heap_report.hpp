#pragma once

#include <span>

#include "bench/recognition/trial.hpp"

namespace semigeo::recognition {

/// Prints on stdout how many of the objects in heaps are reported, by occlusion and noise, and a
/// line for each one that was missed, with where it was lost. Other kinds are passed over.
/// `min_score` is the score that an object needs.
void print_heaps(std::span<const Outcome> outcomes, double min_score);

}  // namespace semigeo::recognition
