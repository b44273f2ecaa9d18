#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"

namespace semigeo::jobs {
namespace {

std::string key_of(const std::string& name, const std::string& input_xxh3,
                   const SurfaceParameters& parameters) {
  return surface_key(name, input_xxh3, to_json(parameters));
}

TEST(JobKeyTest, OfASurfaceChangesWithEverythingThatTheContentDependsOn) {
  std::set<std::string> keys = {key_of("a.ply", "1234", {})};
  const auto is_new = [&](const std::string& key) { return keys.insert(key).second; };
  EXPECT_TRUE(is_new(key_of("b.ply", "1234", {})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1235", {})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1234", {.levels = 9})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1234", {.evolution = {.curved = false}})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1234", {.evolution = {.step_factor = 1.0000001}})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1234", {.compression = io::Compression::kNone})));
  EXPECT_TRUE(is_new(key_of("a.ply", "1234", {.length_unit = "mm"})));
  EXPECT_FALSE(is_new(key_of("a.ply", "1234", {})));
}

TEST(JobKeyTest, OfTripletsChangesWithEverythingThatTheContentDependsOn) {
  std::set<std::string> keys = {triplets_key("a.ply", "1234", {})};
  const auto is_new = [&](const std::string& key) { return keys.insert(key).second; };
  EXPECT_TRUE(is_new(triplets_key("b.ply", "1234", {})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1235", {})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1234", {.levels = 9})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1234", {.most_features = 9})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1234", {.torsion = false})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1234", {.samples = 9})));
  EXPECT_TRUE(is_new(triplets_key("a.ply", "1234", {.least_reach = 0.5})));
  EXPECT_FALSE(is_new(triplets_key("a.ply", "1234", {})));
}

TEST(JobKeyTest, OfPartitionsAndLibrariesChangesWithTheRunsAndTheirOrder) {
  using Keys = std::vector<std::string>;
  std::set<std::string> keys;
  const auto is_new = [&](const std::string& key) { return keys.insert(key).second; };
  for (const Keys& runs : {Keys{"a", "b"}, Keys{"b", "a"}, Keys{"a"}, Keys{}, Keys{"ab"}}) {
    EXPECT_TRUE(is_new(partition_key(runs, {.first = 0, .end = 7})));
    EXPECT_TRUE(is_new(partition_key(runs, {.first = 7, .end = 9})));
    EXPECT_TRUE(is_new(library_key(runs, {})));
    EXPECT_TRUE(is_new(library_key(runs, {.levels = 9})));
  }
}

TEST(JobKeyTest, OfARecognitionChangesWithEverythingThatTheContentDependsOn) {
  const RecogniseJobData data = {
      .input_name = "x/a.ply", .input_xxh3 = "1234", .library_digest = "567"};
  std::set<std::string> keys = {recognise_key("a.ply", data)};
  const auto is_new = [&](const std::string& name, const auto& change) {
    RecogniseJobData changed = data;
    change(changed);
    return keys.insert(recognise_key(name, changed)).second;
  };
  EXPECT_TRUE(is_new("b.ply", [](auto&) {}));
  EXPECT_TRUE(is_new("a.ply", [](auto& one) { one.input_name = "y/a.ply"; }));
  EXPECT_TRUE(is_new("a.ply", [](auto& one) { one.input_xxh3 = "1235"; }));
  EXPECT_TRUE(is_new("a.ply", [](auto& one) { one.library_digest = "568"; }));
  EXPECT_TRUE(is_new("a.ply", [](auto& one) { one.search.method = RecognitionMethod::kThesis; }));
  EXPECT_TRUE(is_new("a.ply", [](auto& one) { one.search.min_score = 0.9; }));
  EXPECT_FALSE(is_new("a.ply", [](auto& one) { one.library = "/elsewhere"; }));
}

}  // namespace
}  // namespace semigeo::jobs
