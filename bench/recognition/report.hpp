#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/recognition/trial.hpp"

namespace semigeo::recognition {

/// The prefix of kinds of scenes whose object is not in the library.
inline constexpr char kAbsent[] = "X-";

/// Prints on stdout, kind by kind, how many of the objects are recognised, the scores, and the
/// times.
void print(std::span<const Outcome> outcomes);

/// Prints on stdout a line for each scene in which an object was missed or wrong.
void print_misses(std::span<const Outcome> outcomes);

/// Returns all outcomes as JSON. `arguments` is the command line, `models` the names of all models.
std::string json(std::span<const Outcome> outcomes, const std::vector<std::string>& arguments,
                 const std::vector<std::string>& models);

}  // namespace semigeo::recognition
