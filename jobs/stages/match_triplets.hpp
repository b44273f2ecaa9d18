#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognition_tuning.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::jobs {

/// A triplet of a scene that may be a triplet of a model.
struct TripletMatch {
  std::uint32_t triangle = 0;  ///< Triangle of the scene, in whatever order of corners.
  std::uint32_t model = 0;     ///< Index in HashLibrary::models.
  std::array<std::uint16_t, 3> scene_corners = {};  ///< Features of the scene, corner by corner.
  std::array<std::uint16_t, 3> model_corners = {};  ///< Features of the model, corner by corner.
  float weight = 0;                                 ///< 1 / (number of matches of the triangle).
};

/// Holds all matches of a scene.
struct TripletMatches {
  std::vector<TripletMatch> matches;  ///< By model, then in the order of the library.
  std::vector<std::int64_t> first;    ///< (models + 1) First match of each model.
  std::vector<double> votes;          ///< (models) Sum of the weights of each model's matches.
  std::int64_t scene_triplets = 0;    ///< Number of triplets of the scene.
  std::int64_t compared = 0;          ///< Number of pairs of triplets that were compared.
};

/// Looks up the triplets of a scene, which must be sorted by cell. Reads only the blocks of the
/// library in which something may match, each once. A scene with more triangles, or more matches,
/// than the tuning admits is represented by an even share of its triangles. The result does not
/// depend on the number of threads. Throws io::Error if the library cannot be read.
/// Source: thesis 4.5, step 4.
TripletMatches match_triplets(const io::HashLibrary& library,
                              const std::vector<kernels::Triplet>& scene,
                              const LookUpTuning& tuning, const engine::RunContext& context);

}  // namespace semigeo::jobs
