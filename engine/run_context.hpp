#pragma once

#include <stop_token>

#include "engine/observer.hpp"
#include "engine/parallel.hpp"

namespace semigeo::engine {

/// Gives a computation its surroundings: threads, somebody to tell, and the wish that it stop.
struct RunContext {
  Workers& workers;
  Observer& observer;
  std::stop_token stop;
};

}  // namespace semigeo::engine
