#include "jobs/stages/recognition_parameters.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace semigeo::jobs {
namespace {

TEST(RecognitionParametersTest, AreReadBack) {
  const RecognitionParameters unusual = {
      .levels = 7, .most_features = 17, .torsion = false, .samples = 170, .least_reach = 1.0 / 3};
  const RecognitionParameters read = recognition_parameters_from_json(json_of(unusual));
  EXPECT_EQ(read.levels, unusual.levels);
  EXPECT_EQ(read.most_features, unusual.most_features);
  EXPECT_EQ(read.torsion, unusual.torsion);
  EXPECT_EQ(read.samples, unusual.samples);
  EXPECT_EQ(read.least_reach, unusual.least_reach);
  for (const std::string text : {"{}", "[]", R"({"levels":3})"})
    EXPECT_THROW(recognition_parameters_from_json(nlohmann::json::parse(text)), std::runtime_error)
        << text;
}

/// Such a number is kept as a floating-point number, which no integer can hold.
TEST(RecognitionParametersTest, NumbersBeyond64BitsAreRefused) {
  nlohmann::json json = json_of(RecognitionParameters{});
  json["samples"] = 4e26;
  EXPECT_ANY_THROW(recognition_parameters_from_json(json));
}

}  // namespace
}  // namespace semigeo::jobs
