#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"
#include "tests/support/generated_models.hpp"

namespace semigeo::tests {

/// Some made-up models with their triplets, and what a library must say of them, computed by the
/// shortest way there is: one sort.
struct SampleLibrary {
  explicit SampleLibrary(int models, const ModelSize& size = {});

  /// Postings and cells anew, of the triplets there are.
  void post();

  std::vector<kernels::RecognitionModel> models;
  std::vector<std::vector<kernels::Triplet>> triplets;
  std::vector<kernels::Posting> postings;
  std::vector<std::uint64_t> cells;
};

/// Returns the content digest.
std::string write_library(const std::filesystem::path& path, const SampleLibrary& sample);

}  // namespace semigeo::tests
