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

/// Libraries of the same models, each without some of them, made as the program makes them.
/// Features and triplets are computed once.
class ModelLibraries {
 public:
  /// Writes into `folder`, which must exist and stay. Throws io::Error.
  ModelLibraries(ModelSpan models, const jobs::RecognitionParameters& parameters,
                 std::filesystem::path folder, const engine::RunContext& context);

  /// Takes the place of the library before.
  std::unique_ptr<io::HashLibrary> without(const std::vector<std::size_t>& left_out) const;

 private:
  struct Run {
    std::string name;
    std::size_t model = 0;  ///< of the models given
    std::filesystem::path path;
  };
  std::filesystem::path folder_;
  const engine::RunContext& context_;
  std::vector<Run> runs_;  ///< by name
};

}  // namespace semigeo::recognition
