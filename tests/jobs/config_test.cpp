#include "jobs/config.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace semigeo::jobs {
namespace {

TEST(ConfigTest, ParametersAreJsonWithSortedKeys) {
  EXPECT_EQ(to_json(SurfaceParameters{}),
            R"({"compression":"deflate","length_unit":"unknown","levels":8,"step":1.0,)"
            R"("surface":"curved"})");
  const SurfaceParameters other = {.levels = 3,
                                   .curved = false,
                                   .step = 0.1,
                                   .compression = io::Compression::none,
                                   .length_unit = "m\"m"};
  EXPECT_EQ(
      to_json(other),
      R"({"compression":"none","length_unit":"m\"m","levels":3,"step":0.1,"surface":"flat"})");
}

TEST(ConfigTest, EveryParameterShows) {
  const SurfaceParameters plain;
  std::set<std::string> texts = {to_json(plain)};
  for (const int field : {0, 1, 2, 3, 4}) {
    SurfaceParameters changed;
    if (field == 0) changed.levels = 9;
    if (field == 1) changed.curved = false;
    if (field == 2) changed.step = std::nextafter(1.0, 2.0);
    if (field == 3) changed.compression = io::Compression::none;
    if (field == 4) changed.length_unit = "mm";
    EXPECT_TRUE(texts.insert(to_json(changed)).second) << "field " << field;
    EXPECT_TRUE(nlohmann::json::accept(to_json(changed)));
  }
}

}  // namespace
}  // namespace semigeo::jobs
