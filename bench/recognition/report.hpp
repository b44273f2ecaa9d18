#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/recognition/trial.hpp"

namespace semigeo::recognition {

/// Kinds of scenes whose object is not in the library have this before their name.
inline constexpr char kAbsent[] = "X-";

/// How often what is there is recognised, kind by kind; scores; seconds.
void print(std::span<const Outcome> outcomes);

/// A line for each scene in which something was missed or wrong.
void print_misses(std::span<const Outcome> outcomes);

/// Everything, as JSON; `arguments` is the command line.
std::string json(std::span<const Outcome> outcomes, const std::vector<std::string>& arguments,
                 const std::vector<std::string>& models);

}  // namespace semigeo::recognition
