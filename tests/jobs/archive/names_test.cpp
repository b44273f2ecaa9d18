#include "jobs/archive/names.hpp"

#include <gtest/gtest.h>

namespace semigeo::jobs {
namespace {

TEST(NamesTest, AGivenNameIsThePathBelowTheSearchedFolder) {
  const auto given = [](const std::string& relative) {
    return given_name("/disk/scans/" + relative, dataset_name(relative));
  };
  for (const std::string relative :
       {"a.ply", "day 1/a.ply", "box.zip/part/spike.ply", "a__b/c.ply", "像 7.ply", ".x/a.ply"})
    EXPECT_EQ(given(relative), relative);
  const std::string longest = std::string(150, 'a') + "/" + std::string(150, 'b') + ".ply";
  EXPECT_EQ(given(longest), longest);
  EXPECT_EQ(given_name("scans/day/a.ply", "day__a.ply"), "day/a.ply");
  EXPECT_EQ(given_name("a.ply", "a.ply"), "a.ply");
  EXPECT_EQ(given_name("/a.ply", "a.ply"), "a.ply");
}

TEST(NamesTest, AScanWhosePathAnotherOneHasIsToldApart) {
  const std::string name = name_with_hash("day__a.ply", "/disk/day/a.ply");
  EXPECT_EQ(given_name("/disk/day/a.ply", name), "day/a.ply (" + name + ")");
}

TEST(NamesTest, ANameWithoutItsScanIsShownAsItIs) {
  EXPECT_EQ(given_name("", "day__a.ply"), "day__a.ply");
  EXPECT_EQ(given_name("/moved/b.ply", "day__a.ply"), "b.ply (day__a.ply)");
}

}  // namespace
}  // namespace semigeo::jobs
