#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"
#include "bench/support/chance.hpp"

namespace semigeo::recognition {

/// Drops models onto a floor at z = 0 and onto one another, in the order of their indices: each is
/// turned at random, put at a random place near the middle, and lowered until it meets the floor or
/// what lies there. No two objects cross. Surfaces are compared on a grid of heights whose cells
/// are a hundredth of an object's size, so there may be gaps of about that size. Objects do not
/// fall over. `objects` holds indices of models.
std::vector<PlacedObject> drop_heap(ModelSpan models, std::span<const std::size_t> objects,
                                    bench::Random& random);

}  // namespace semigeo::recognition
