#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/recognition/recognition_model.hpp"

namespace semigeo::tests {

/// How much a made-up model has.
struct ModelSize {
  int features = 300;
  int samples = 500;
  int triplets = 1000;
};

/// "model-000017": ascending with the index.
std::string generated_name(int index);

/// Made up by chance from the index alone: for tests of how models are stored.
kernels::RecognitionModel generated_model(int index, const ModelSize& size);

/// Of such a model; sorted, none twice. Shapes in the middle are the most frequent ones.
std::vector<kernels::Triplet> generated_triplets(int index, const kernels::RecognitionModel& model,
                                                 const ModelSize& size);

}  // namespace semigeo::tests
