#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::jobs {

/// A triplet of a scene that may be one of a model.
struct TripletMatch {
  std::uint32_t triangle = 0;                       ///< of the scene, in whatever order of corners
  std::uint32_t model = 0;                          ///< of HashLibrary::models
  std::array<std::uint16_t, 3> scene_corners = {};  ///< features, corner by corner
  std::array<std::uint16_t, 3> model_corners = {};
  float weight = 0;  ///< 1 / number of matches of the triangle
};

struct TripletMatches {
  std::vector<TripletMatch> matches;  ///< by model, then as in the library
  std::vector<std::int64_t> first;    ///< (models + 1) first match of each model
  std::vector<double> votes;          ///< (models) weights together
  std::int64_t scene_triplets = 0;
  std::int64_t compared = 0;  ///< pairs of triplets that were looked at
};

/// Where a scene has more, an even share of its triangles is looked up: an object that is seen well
/// has hundreds of them.
struct MatchLimits {
  std::int64_t triangles = 32'000;
  std::int64_t compared = 3'000'000'000;  ///< pairs of triplets
  std::int64_t matches = 8'000'000;  ///< as far as a few blocks of a large library tell beforehand
};

/// Looks up the triplets of a scene, which must be sorted by cell. Reads only the blocks of the
/// library in which something may match, each once. Does not depend on the number of threads.
/// Source: thesis 4.5, step 4.
TripletMatches match_triplets(const io::HashLibrary& library,
                              const std::vector<kernels::Triplet>& scene, const MatchLimits& limits,
                              const engine::RunContext& context);

}  // namespace semigeo::jobs
