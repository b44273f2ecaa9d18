#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/recognition/scenes.hpp"
#include "bench/support/chance.hpp"

namespace semigeo::recognition {

/// Returns the diagonal that a model has in all heaps: 1, by up to a third more or less. It follows
/// from the model's name, so that the sizes of different objects fit together in every heap.
double size_in_heaps(const BenchModel& model);

/// Drops models onto a floor at z = 0 and onto one another, in the order of their indices: each is
/// turned at random, put at a random place near the middle, and lowered until it meets the floor or
/// what lies there. No two objects cross. Surfaces are compared on a grid of heights whose cells
/// are a hundredth of an object's size, so there may be gaps of about that size. Objects do not
/// fall over. `objects` holds indices of models.
std::vector<PlacedObject> drop_heap(ModelSpan models, std::span<const std::size_t> objects,
                                    bench::Random& random);

}  // namespace semigeo::recognition
