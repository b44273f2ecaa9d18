#include "jobs/stages/surface_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/jobs/stages/unusual_parameters.hpp"

namespace semigeo::jobs {
namespace {

TEST(SurfaceParametersTest, AreJsonWithSortedKeys) {
  EXPECT_EQ(
      to_json(SurfaceParameters{}),
      R"({"compression":"deflate","coordinates":"semigeodesic","decimate":"0.0 edges",)"
      R"("feature_completeness":0.6,"feature_radius":1.5,"fill_holes":0,)"
      R"("length_unit":"unknown","level":"slope","levels":8,"principal":false,)"
      R"("remesh":true,"rescale":"size","schedule":"uniform","step":1.0,"surface":"curved","target_vertices":0,"weld":"auto"})");
  const SurfaceParameters other = unusual_parameters();
  EXPECT_EQ(
      to_json(other),
      R"({"compression":"none","coordinates":"polar","decimate":"0.25 length units","depth_jump":6.5,)"
      R"("feature_completeness":0.75,"feature_radius":0.0,"fill_holes":40,)"
      R"("length_unit":"m\"m","level":2,"levels":3,"principal":true,)"
      R"("remesh":false,"rescale":"edges","schedule":"octaves","step":0.1,"surface":"flat","target_vertices":1993,"weld":"0.5"})");
  for (const SurfaceParameters& parameters : {SurfaceParameters{}, other})
    EXPECT_EQ(to_json(surface_parameters_from_json(json_of(parameters))), to_json(parameters));
  for (const std::string text : {"{}", "[]", R"({"levels":8})"})
    EXPECT_THROW(surface_parameters_from_json(nlohmann::json::parse(text)), std::runtime_error)
        << text;
}

TEST(SurfaceParametersTest, EachOfThemShows) {
  const SurfaceParameters plain;
  std::set<std::string> texts = {to_json(plain)};
  for (const int field : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}) {
    SurfaceParameters changed;
    if (field == 0) changed.levels = 9;
    if (field == 13) changed.weld = "exact";
    if (field == 1) changed.evolution.curved = false;
    if (field == 2) changed.evolution.step_factor = std::nextafter(1.0, 2.0);
    if (field == 3) changed.compression = io::Compression::kNone;
    if (field == 4) changed.length_unit = "mm";
    if (field == 5) changed.evolution.coordinates = kernels::Coordinates::kPolar;
    if (field == 6) changed.evolution.schedule = Schedule::kOctaves;
    if (field >= 8) changed.preparation.decimate = 1;
    if (field == 9) changed.preparation.decimate_in_length_units = true;
    if (field == 10) changed.preparation.fill_holes = 3;
    if (field == 12) changed.evolution.rescale = Rescale::kNone;
    if (field == 11) changed.preparation.target_vertices = 100;
    if (field == 14) changed.depth_jump = 5;
    if (field == 7) changed.evolution.principal = true;
    EXPECT_TRUE(texts.insert(to_json(changed)).second) << "field " << field;
    EXPECT_TRUE(nlohmann::json::accept(to_json(changed)));
  }
}

TEST(SurfaceParametersTest, HaveKeysNamesAndHelpOfTheirOwn) {
  std::set<std::string> keys;
  std::set<std::string> names;
  for (const Parameter<SurfaceParameters>& row : surface_parameter_table()) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_STRNE(row.key, "");
    EXPECT_STRNE(row.name, "");
    EXPECT_STRNE(row.help, "") << row.name;
  }
}

/// A configuration file cannot hold a control character, and a terminal should not.
TEST(SurfaceParametersTest, UnitsAreNamesThatCanBeWrittenAndShown) {
  for (const Parameter<SurfaceParameters>& row : surface_parameter_table()) {
    if (row.key != std::string("length_unit")) continue;
    const auto problem = std::get<Text<SurfaceParameters>>(row.value).problem;
    for (const char* unit : {"mm", "inch", "µm", "nautical mile"}) EXPECT_EQ(problem(unit), "");
    for (const char* unit : {"", "m\x04", "m\nm", "m\x1b[0m", "m\xe2\x80\xaem", "m\"", "m\\"})
      EXPECT_NE(problem(unit), "") << unit;
  }
}

}  // namespace
}  // namespace semigeo::jobs
