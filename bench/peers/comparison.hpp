#pragma once

#include <string>
#include <vector>

#include "bench/peers/method.hpp"

namespace semigeo::peers {

/// Says what a method needs for a vertex of a subject, and how far off it is.
struct MethodRow {
  std::string subject;
  std::string library;
  std::string method;
  double least_microseconds = 0;   ///< Least CPU time of all runs.
  double median_microseconds = 0;  ///< Median CPU time of all runs.
  double gaussian_error = 0;       ///< Median relative error of K, in per cent; NaN if unknown.
  double mean_error = 0;           ///< Median relative error of H, in per cent; NaN if unknown.
};

/// Runs all methods of all libraries on a subject in turns, `rounds` times.
std::vector<MethodRow> compare_methods(const Subject& subject,
                                       const std::vector<Library>& libraries, int rounds);

}  // namespace semigeo::peers
