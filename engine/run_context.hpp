#pragma once

#include <stop_token>

#include "engine/observer.hpp"
#include "engine/parallel.hpp"

namespace semigeo::engine {

/// What a computation is given of its surroundings: threads, the wish that it stop, somebody to
/// tell.
struct RunContext {
  Workers& workers;
  Observer& observer;
  std::stop_token stop;
};

}  // namespace semigeo::engine
