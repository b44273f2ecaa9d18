#include "jobs/plan/config.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/jobs/plan/unusual_parameters.hpp"

namespace semigeo::jobs {
namespace {

TEST(ConfigTest, ParametersAreJsonWithSortedKeys) {
  EXPECT_EQ(
      to_json(SurfaceParameters{}),
      R"({"compression":"deflate","coordinates":"semigeodesic","decimate":"0.0 edges",)"
      R"("feature_completeness":0.6,"feature_radius":1.5,"fill_holes":0,)"
      R"("length_unit":"unknown","level":"slope","levels":8,"principal":false,)"
      R"("remesh":true,"rescale":"size","schedule":"uniform","step":1.0,"surface":"curved","target_vertices":0})");
  const SurfaceParameters other = unusual_parameters();
  EXPECT_EQ(
      to_json(other),
      R"({"compression":"none","coordinates":"polar","decimate":"0.25 length units",)"
      R"("feature_completeness":0.75,"feature_radius":0.0,"fill_holes":40,)"
      R"("length_unit":"m\"m","level":2,"levels":3,"principal":true,)"
      R"("remesh":false,"rescale":"edges","schedule":"octaves","step":0.1,"surface":"flat","target_vertices":1993})");
  for (const SurfaceParameters& parameters : {SurfaceParameters{}, other})
    EXPECT_EQ(to_json(parameters_from_json(to_json(parameters))), to_json(parameters));
  for (const char* text : {"", "{}", "[]", R"({"levels":8})"})
    EXPECT_THROW(parameters_from_json(text), std::runtime_error) << text;
}

TEST(ConfigTest, EveryParameterShows) {
  const SurfaceParameters plain;
  std::set<std::string> texts = {to_json(plain)};
  for (const int field : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}) {
    SurfaceParameters changed;
    if (field == 0) changed.levels = 9;
    if (field == 1) changed.evolution.curved = false;
    if (field == 2) changed.evolution.step_factor = std::nextafter(1.0, 2.0);
    if (field == 3) changed.compression = io::Compression::none;
    if (field == 4) changed.length_unit = "mm";
    if (field == 5) changed.evolution.coordinates = kernels::Coordinates::polar;
    if (field == 6) changed.evolution.schedule = Schedule::octaves;
    if (field >= 8) changed.preparation.decimate = 1;
    if (field == 9) changed.preparation.decimate_in_length_units = true;
    if (field == 10) changed.preparation.fill_holes = 3;
    if (field == 12) changed.evolution.rescale = Rescale::none;
    if (field == 11) changed.preparation.target_vertices = 100;
    if (field == 7) changed.evolution.principal = true;
    EXPECT_TRUE(texts.insert(to_json(changed)).second) << "field " << field;
    EXPECT_TRUE(nlohmann::json::accept(to_json(changed)));
  }
}

TEST(ConfigTest, RecognitionParametersAreReadBack) {
  const RecognitionParameters unusual = {
      .levels = 7, .most_features = 17, .torsion = false, .samples = 170, .least_reach = 1.0 / 3};
  const RecognitionParameters read = recognition_parameters_from_json(to_json(unusual));
  EXPECT_EQ(read.levels, unusual.levels);
  EXPECT_EQ(read.most_features, unusual.most_features);
  EXPECT_EQ(read.torsion, unusual.torsion);
  EXPECT_EQ(read.samples, unusual.samples);
  EXPECT_EQ(read.least_reach, unusual.least_reach);
  for (const char* text : {"", "{}", "[]", R"({"levels":3})"})
    EXPECT_THROW(recognition_parameters_from_json(text), std::runtime_error) << text;
}

TEST(ConfigTest, SearchParametersAreReadBack) {
  for (const SearchParameters& parameters :
       {SearchParameters{},
        SearchParameters{.method = RecognitionMethod::kThesis, .min_score = 1.0 / 3}})
    EXPECT_EQ(to_json(search_parameters_from_json(to_json(parameters))), to_json(parameters));
  EXPECT_NE(to_json(SearchParameters{.method = RecognitionMethod::kThesis}),
            to_json(SearchParameters{}));
  for (const char* text : {"", "{}", "[]", R"({"method":"thesis"})"})
    EXPECT_THROW(search_parameters_from_json(text), std::runtime_error) << text;
}

}  // namespace
}  // namespace semigeo::jobs
