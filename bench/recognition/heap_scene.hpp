#pragma once

#include <cstdint>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"

namespace semigeo::recognition {

/// The kind of scenes that are heaps, seen by a scanner from one side.
inline constexpr char kHeap[] = "R";

/// Makes scene `number` of a seed: a heap of three to six different models, scanned from a random
/// place above it by a virtual scanner (virtual_scanner.hpp). The objects have the surfaces of the
/// files before decimation. The noise is 0, 0.1 or 0.25 pixels; depths are rounded to 0.05 pixels;
/// every second scene has mixed pixels. The scanner stands at the origin. Objects of which nothing
/// is seen are not listed. The same models, number and seed give the same scene. Throws
/// std::runtime_error if there are fewer than six models.
Scene make_heap_scene(ModelSpan models, int number, std::uint64_t seed);

}  // namespace semigeo::recognition
