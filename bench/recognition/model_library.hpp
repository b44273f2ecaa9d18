#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "engine/run_context.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/stages/recognition_features.hpp"

namespace semigeo::recognition {

/// Makes libraries of the same models, each without some of them, as the program makes them.
/// Features and triplets are computed once.
class ModelLibraries {
 public:
  /// Writes the runs of all models into `folder`, which must exist and stay. Throws io::Error if
  /// they cannot be written.
  ModelLibraries(ModelSpan models, const jobs::RecognitionParameters& parameters,
                 std::filesystem::path folder, const engine::RunContext& context);

  /// Makes and opens the library without the models `left_out` (indices). It replaces the file of
  /// the library that was made before. Throws io::Error if it cannot be written.
  std::unique_ptr<io::HashLibrary> without(const std::vector<std::size_t>& left_out) const;

 private:
  struct Run {
    std::string name;
    std::size_t model = 0;  ///< Index in the models given.
    std::filesystem::path path;
  };
  std::filesystem::path folder_;
  const engine::RunContext& context_;
  std::vector<Run> runs_;  ///< Sorted by name.
};

}  // namespace semigeo::recognition
