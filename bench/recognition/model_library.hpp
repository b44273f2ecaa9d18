#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "engine/run_context.hpp"
#include "io/hash_library.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "kernels/recognition_model.hpp"
#include "kernels/triplet.hpp"

namespace semigeo::recognition {

/// Libraries of the same models, each without some of them. Features and triplets
/// are computed once.
class ModelLibraries {
 public:
  /// Writes into `folder`, which must exist and stay. Throws io::Error.
  ModelLibraries(ModelSpan models, const jobs::RecognitionParameters& parameters,
                 std::filesystem::path folder, const engine::RunContext& context);

  /// Takes the place of the library before.
  std::unique_ptr<io::HashLibrary> without(const std::vector<std::size_t>& left_out) const;

 private:
  struct Entry {
    std::size_t index = 0;  ///< of the models given
    kernels::RecognitionModel model;
    std::vector<kernels::Triplet> triplets;
  };
  std::filesystem::path folder_;
  std::vector<Entry> entries_;  ///< by name
};

}  // namespace semigeo::recognition
