#include "kernels/recognition/triplet.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "tests/support/random_features.hpp"

namespace semigeo::kernels {
namespace {

using Eigen::Vector3f;

/// Whether a triplet of `scene` finds `triplet`.
bool finds(const std::vector<Triplet>& scene, const Triplet& triplet) {
  return std::ranges::any_of(scene, [&](const Triplet& t) {
    const auto cells = cells_around(t.cell);
    return t.corners == triplet.corners && std::ranges::binary_search(cells, triplet.cell) &&
           compatible(t.invariants, triplet.invariants);
  });
}

TEST(Triplet, SidesAreWithinTheBandAndInOrder) {
  const OrientedFeatures features = random_features(60, 1);
  const TripletOptions options;
  const std::vector<Triplet> triplets = local_triplets(features, options);
  ASSERT_GT(triplets.size(), 500U);
  std::set<std::array<std::uint16_t, 3>> seen;
  for (const Triplet& t : triplets) {
    const auto side = [&](int a, int b) {
      return (features.features[t.corners[a]].position - features.features[t.corners[b]].position)
          .norm();
    };
    EXPECT_GE(side(1, 2), side(2, 0));
    EXPECT_GE(side(2, 0), side(0, 1));
    EXPECT_GE(side(0, 1), options.nearest);
    std::array<std::uint16_t, 3> corners = t.corners;
    std::ranges::sort(corners);
    EXPECT_TRUE(seen.insert(corners).second) << "a triangle entered twice";
  }
  EXPECT_TRUE(std::ranges::is_sorted(triplets, {}, &Triplet::cell));
}

TEST(Triplet, IsOfTheNearestFeaturesOnly) {
  const OrientedFeatures features = random_features(200, 2);
  TripletOptions few;
  few.neighbours = 2;
  // Each feature with the pair of its two neighbours: no more triangles than features.
  EXPECT_LE(local_triplets(features, few).size(), 200U);
  EXPECT_GT(local_triplets(features, {}).size(), 1000U);
}

// By the definition, feature after feature.
std::set<std::array<std::uint16_t, 3>> triangles_of(const OrientedFeatures& features,
                                                    const TripletOptions& options) {
  const auto& all = features.features;
  const auto distance = [&](std::size_t i, std::size_t j) {
    return (all[i].position - all[j].position).norm();
  };
  std::set<std::array<std::uint16_t, 3>> triangles;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<std::uint16_t> near;
    for (std::size_t j = 0; j < all.size(); ++j)
      if (distance(i, j) >= options.nearest && distance(i, j) <= options.farthest)
        near.push_back(static_cast<std::uint16_t>(j));
    std::ranges::sort(near, {}, [&](std::uint16_t j) { return distance(i, j); });
    near.resize(std::min<std::size_t>(near.size(), options.neighbours));
    for (const std::uint16_t j : near)
      for (const std::uint16_t k : near) {
        if (j >= k || distance(j, k) < options.nearest) continue;
        std::array<std::uint16_t, 3> triangle = {static_cast<std::uint16_t>(i), j, k};
        const Vector3f across =
            (all[j].position - all[i].position).cross(Vector3f(all[k].position - all[i].position));
        const float longest = std::max({distance(i, j), distance(i, k), distance(j, k)});
        if (across.norm() < options.min_height * longest * longest) continue;
        std::ranges::sort(triangle);
        triangles.insert(triangle);
      }
  }
  return triangles;
}

TEST(Triplet, AreThoseOfTheDefinition) {
  const TripletOptions options;
  for (const int count : {3, 30, 300}) {
    const OrientedFeatures features = random_features(count, 7);
    std::set<std::array<std::uint16_t, 3>> found;
    for (const Triplet& triplet : local_triplets(features, options)) {
      std::array<std::uint16_t, 3> corners = triplet.corners;
      std::ranges::sort(corners);
      found.insert(corners);
    }
    EXPECT_EQ(found, triangles_of(features, options));
  }
}

TEST(Triplet, NoneFromFeaturesOnALine) {
  OrientedFeatures features = random_features(12, 3);
  for (std::size_t i = 0; i < features.features.size(); ++i)
    features.features[i].position = {3.0F * static_cast<float>(i), 0, 0};
  EXPECT_TRUE(local_triplets(features, {}).empty());
}

TEST(Triplet, LevelsDoNotMix) {
  OrientedFeatures features = random_features(40, 4);
  features.level_scale = {1, 2};
  for (std::size_t i = 20; i < 40; ++i) features.features[i].level = 1;
  for (const Triplet& t : local_triplets(features, {})) {
    const bool second = t.corners[0] >= 20;
    EXPECT_EQ(t.corners[1] >= 20, second);
    EXPECT_EQ(t.corners[2] >= 20, second);
  }
}

TEST(Triplet, ASimilarityLosesNone) {
  std::mt19937_64 random(5);
  const OrientedFeatures features = random_features(60, 5);
  const std::vector<Triplet> model = local_triplets(features, {});
  TripletOptions scene_options;
  scene_options.every_order = true;
  for (int trial = 0; trial < 5; ++trial) {
    const auto scene = local_triplets(moved(features, random_similarity(random)), scene_options);
    const auto lost =
        std::ranges::count_if(model, [&](const Triplet& t) { return !finds(scene, t); });
    EXPECT_LE(lost, 2) << "of " << model.size();  // at the edge of the band
  }
}

// Places off by a tenth of sigma, curvatures by a tenth, normals by up to 15 degrees.
TEST(Triplet, NoiseLosesFew) {
  std::mt19937_64 random(6);
  const OrientedFeatures features = random_features(60, 6);
  OrientedFeatures noisy = moved(features, random_similarity(random));
  for (OrientedFeature& f : noisy.features) {
    f.position += 0.1F * noisy.level_scale[0] * random_direction(random).cast<float>();
    f.normal = (f.normal + 0.25F * random_direction(random).cast<float>()).normalized();
    f.scale_free_gaussian *= 1.1F;
    f.scale_free_mean *= 0.9F;
  }
  TripletOptions scene_options;
  scene_options.every_order = true;
  scene_options.neighbours = 14;
  const std::vector<Triplet> model = local_triplets(features, {});
  const std::vector<Triplet> scene = local_triplets(noisy, scene_options);
  const auto found =
      std::ranges::count_if(model, [&](const Triplet& t) { return finds(scene, t); });
  EXPECT_GT(static_cast<double>(found), 0.9 * static_cast<double>(model.size()));
}

TEST(Triplet, AMirrorImageIsAnother) {
  const OrientedFeatures features = random_features(60, 7);
  OrientedFeatures mirrored = features;
  for (OrientedFeature& f : mirrored.features) {
    f.position.x() = -f.position.x();
    f.normal.x() = -f.normal.x();
  }
  TripletOptions scene_options;
  scene_options.every_order = true;
  const std::vector<Triplet> model = local_triplets(features, {});
  const std::vector<Triplet> scene = local_triplets(mirrored, scene_options);
  const auto found =
      std::ranges::count_if(model, [&](const Triplet& t) { return finds(scene, t); });
  EXPECT_LT(static_cast<double>(found), 0.1 * static_cast<double>(model.size()));
}

/// A triangle of sides 5, 4, 3.5 with curvatures 0.5 everywhere and normals upwards.
OrientedFeatures one_triangle() {
  OrientedFeatures features = random_features(3, 8);
  const Vector3f places[] = {{1.6F, 3.2F, 0}, {0, 0, 0}, {5, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    OrientedFeature& f = features.features[i];
    f.position = places[i];
    f.normal = {0, 0, 1};
    f.scale_free_gaussian = f.scale_free_mean = 0.5F;
    f.code = 0;
  }
  return features;
}

bool still_matches(const OrientedFeatures& changed) {
  TripletOptions options;
  options.every_order = true;
  options.nearest = 1;
  return finds(local_triplets(changed, options), local_triplets(one_triangle(), {}).front());
}

TEST(Triplet, TolerancesAreThoseOfTheRecipe) {
  ASSERT_TRUE(still_matches(one_triangle()));
  const auto with = [](auto change) {
    OrientedFeatures features = one_triangle();
    change(features);
    return still_matches(features);
  };
  // Scale: log 1.35 = 0.3, log 1.5 = 0.41.
  EXPECT_TRUE(with([](auto& f) { f.level_scale[0] *= 1.35F; }));
  EXPECT_FALSE(with([](auto& f) { f.level_scale[0] *= 1.5F; }));
  // Curvature 0.5: 0.25 + 0.35 * 0.5 = 0.425.
  EXPECT_TRUE(with([](auto& f) { f.features[1].scale_free_mean -= 0.33F; }));
  EXPECT_FALSE(with([](auto& f) { f.features[1].scale_free_mean -= 0.5F; }));
  EXPECT_FALSE(with([](auto& f) { f.features[2].scale_free_gaussian += 0.6F; }));
  // Normals: 30 degrees.
  const auto tilt = [](double degrees) {
    return [degrees](OrientedFeatures& f) {
      const double a = degrees / 57.2958;
      f.features[0].normal = {0, static_cast<float>(std::sin(a)), static_cast<float>(std::cos(a))};
    };
  };
  EXPECT_TRUE(with(tilt(27)));
  EXPECT_TRUE(with(tilt(-27)));
  EXPECT_FALSE(with(tilt(33)));
  EXPECT_FALSE(with(tilt(-33)));
  // A corner moved: the ratio of the sides.
  EXPECT_TRUE(with([](auto& f) { f.features[0].position.y() += 0.3F; }));
  EXPECT_FALSE(with([](auto& f) { f.features[0].position.y() += 0.9F; }));
  // The kind or the sign of a feature.
  EXPECT_FALSE(with([](auto& f) { f.features[0].code = 1; }));
}

TEST(Triplet, CellsAroundAreItselfAndItsNeighbours) {
  const auto shape = [](int second, int third, int scale) {
    return (second * kThirdRatioBins + third) * kScaleBins + scale;
  };
  const std::uint32_t inner = shape(3, 4, 5) * kCodeTriples + 77;
  const auto cells = cells_around(inner);
  EXPECT_EQ(cells.size(), 27U);
  EXPECT_TRUE(std::ranges::is_sorted(cells));
  EXPECT_TRUE(std::ranges::binary_search(cells, inner));
  for (const std::uint32_t cell : cells) EXPECT_EQ(cell % kCodeTriples, 77U);
  EXPECT_EQ(cells_around(0).size(), 8U);
  const auto last = cells_around(kTripletCells - 1);
  EXPECT_EQ(last.size(), 8U);
  EXPECT_EQ(last.back(), static_cast<std::uint32_t>(kTripletCells - 1));
}

}  // namespace
}  // namespace semigeo::kernels
