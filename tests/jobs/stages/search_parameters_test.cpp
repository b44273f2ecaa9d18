#include "jobs/stages/search_parameters.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace semigeo::jobs {
namespace {

TEST(SearchParametersTest, AreReadBack) {
  for (const SearchParameters& parameters :
       {SearchParameters{},
        SearchParameters{.method = RecognitionMethod::kThesis, .min_score = 1.0 / 3},
        SearchParameters{.depth_jump = 6}})
    EXPECT_EQ(to_json(search_parameters_from_json(json_of(parameters))), to_json(parameters));
  EXPECT_NE(to_json(SearchParameters{.method = RecognitionMethod::kThesis}),
            to_json(SearchParameters{}));
  EXPECT_EQ(json_of(SearchParameters{.depth_jump = 6}).at("depth_jump"), 6);
  EXPECT_FALSE(json_of(SearchParameters{}).contains("depth_jump"));
  for (const std::string text : {"{}", "[]", R"({"method":"thesis"})"})
    EXPECT_THROW(search_parameters_from_json(nlohmann::json::parse(text)), std::runtime_error)
        << text;
}

}  // namespace
}  // namespace semigeo::jobs
