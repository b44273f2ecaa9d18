#include "jobs/plan/job_key.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

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
  std::set<std::string> keys = {recognise_key("a.ply", "x/a.ply", "1234", "567", {})};
  const auto is_new = [&](const std::string& key) { return keys.insert(key).second; };
  EXPECT_TRUE(is_new(recognise_key("b.ply", "x/a.ply", "1234", "567", {})));
  EXPECT_TRUE(is_new(recognise_key("a.ply", "y/a.ply", "1234", "567", {})));
  EXPECT_TRUE(is_new(recognise_key("a.ply", "x/a.ply", "1235", "567", {})));
  EXPECT_TRUE(is_new(recognise_key("a.ply", "x/a.ply", "1234", "568", {})));
  EXPECT_TRUE(is_new(
      recognise_key("a.ply", "x/a.ply", "1234", "567", {.method = RecognitionMethod::kThesis})));
  EXPECT_TRUE(is_new(recognise_key("a.ply", "x/a.ply", "1234", "567", {.min_score = 0.9})));
  EXPECT_FALSE(is_new(recognise_key("a.ply", "x/a.ply", "1234", "567", {})));
}

}  // namespace
}  // namespace semigeo::jobs
