#pragma once

#include <stop_token>

#include "engine/observer.hpp"
#include "engine/parallel.hpp"

namespace semigeo::engine {

/// Holds what a computation needs besides its data.
struct RunContext {
  Workers& workers;      ///< The threads that it may use.
  Observer& observer;    ///< Receives the events of the computation.
  std::stop_token stop;  ///< Tells whether the computation should stop.
};

}  // namespace semigeo::engine
