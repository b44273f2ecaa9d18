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
        SearchParameters{.depth_jump = 6}, SearchParameters{.view = ViewChoice::kNone},
        SearchParameters{.scale = "0.5..2"}})
    EXPECT_EQ(to_json(search_parameters_from_json(json_of(parameters))), to_json(parameters));
  EXPECT_NE(to_json(SearchParameters{.method = RecognitionMethod::kThesis}),
            to_json(SearchParameters{}));
  EXPECT_EQ(json_of(SearchParameters{.depth_jump = 6}).at("depth_jump"), 6);
  EXPECT_EQ(json_of(SearchParameters{.view = ViewChoice::kNone}).at("view"), "none");
  EXPECT_EQ(json_of(SearchParameters{.scale = "known"}).at("scale"), "known");
  for (const char* key : {"depth_jump", "view", "scale"})
    EXPECT_FALSE(json_of(SearchParameters{}).contains(key)) << key;
  for (const std::string text : {"{}", "[]", R"({"method":"thesis"})"})
    EXPECT_THROW(search_parameters_from_json(nlohmann::json::parse(text)), std::runtime_error)
        << text;
}

TEST(ScaleRangeTest, IsReadFromItsText) {
  EXPECT_TRUE(scale_range("any").is_any());
  const ScaleRange known = scale_range("known");
  EXPECT_TRUE(known.has(0.92) && known.has(1) && known.has(1.09));
  EXPECT_FALSE(known.has(0.9) || known.has(1.11));
  EXPECT_EQ(scale_range("0.25..4").least, 0.25);
  EXPECT_EQ(scale_range("0.25..4").most, 4);
  EXPECT_EQ(scale_range("2..2").most, 2);
  for (const char* text : {"", "unknown", "1", "1..", "..1", "2..1", "0..1", "-1..1", "1..nan",
                           "1..inf", "1...2", "1..2x"})
    EXPECT_THROW(scale_range(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace semigeo::jobs
