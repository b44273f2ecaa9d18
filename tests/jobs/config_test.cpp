#include "jobs/config.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace semigeo::jobs {
namespace {

TEST(ConfigTest, ParametersAreJsonWithSortedKeys) {
  EXPECT_EQ(to_json(SurfaceParameters{}),
            R"({"compression":"deflate","coordinates":"semigeodesic","length_unit":"unknown",)"
            R"("levels":8,"principal":false,"schedule":"uniform","step":1.0,"surface":"curved"})");
  const SurfaceParameters other = {.levels = 3,
                                   .evolution = {.curved = false,
                                                 .coordinates = kernels::Coordinates::polar,
                                                 .schedule = Schedule::octaves,
                                                 .principal = true,
                                                 .step_factor = 0.1},
                                   .compression = io::Compression::none,
                                   .length_unit = "m\"m"};
  EXPECT_EQ(to_json(other),
            R"({"compression":"none","coordinates":"polar","length_unit":"m\"m","levels":3,)"
            R"("principal":true,"schedule":"octaves","step":0.1,"surface":"flat"})");
}

TEST(ConfigTest, EveryParameterShows) {
  const SurfaceParameters plain;
  std::set<std::string> texts = {to_json(plain)};
  for (const int field : {0, 1, 2, 3, 4, 5, 6, 7}) {
    SurfaceParameters changed;
    if (field == 0) changed.levels = 9;
    if (field == 1) changed.evolution.curved = false;
    if (field == 2) changed.evolution.step_factor = std::nextafter(1.0, 2.0);
    if (field == 3) changed.compression = io::Compression::none;
    if (field == 4) changed.length_unit = "mm";
    if (field == 5) changed.evolution.coordinates = kernels::Coordinates::polar;
    if (field == 6) changed.evolution.schedule = Schedule::octaves;
    if (field == 7) changed.evolution.principal = true;
    EXPECT_TRUE(texts.insert(to_json(changed)).second) << "field " << field;
    EXPECT_TRUE(nlohmann::json::accept(to_json(changed)));
  }
}

}  // namespace
}  // namespace semigeo::jobs
