#pragma once

#include <cstdint>
#include <span>

#include "bench/peers/method.hpp"

namespace semigeo::peers {

/// Says which vertices a jet is fitted to.
struct JetOptions {
  int degree = 2;
  /// All vertices within this distance are used. With 0 it is as many rings as the number of
  /// coefficients needs, as in CGAL's example.
  double radius = 0;
};

/// Fits jets by CGAL::Monge_via_jet_fitting at the vertices whose mark in `wanted` is set; all if
/// it is empty. Other vertices get NaN. The time is that of all fits, with the search for
/// neighbours.
Result fit_jets(const Subject& subject, const JetOptions& options,
                std::span<const std::uint8_t> wanted = {});

}  // namespace semigeo::peers
