#pragma once

#include <stdexcept>
#include <string>
#include <variant>

#include "engine/child_process.hpp"

namespace semigeo::engine {

inline constexpr double kLong = 600;  // a test that waits so long has failed

inline Command shell(const std::string& script) {
  Command command;
  command.arguments = {"/bin/sh", "-c", script};
  return command;
}

inline Command conversing(const std::string& script) {
  Command command = shell(script);
  command.converses = true;
  return command;
}

/// The next event if it is what the test expects.
template <class Expected>
Expected next(ChildProcesses& children) {
  const auto event = children.wait(kLong);
  const auto* expected = std::get_if<Expected>(&event);
  if (expected == nullptr)
    throw std::runtime_error("an event of type " + std::to_string(event.index()));
  return *expected;
}

}  // namespace semigeo::engine
