#include "bench/recognition/heap_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bench/recognition/heap.hpp"
#include "bench/recognition/touching.hpp"
#include "bench/support/mesh_changes.hpp"
#include "kernels/surface/bounding_box.hpp"
#include "tests/support/shapes.hpp"

namespace semigeo::recognition {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

BenchModels six_models() {
  BenchModels models;
  for (int i = 0; i < 3; ++i) {
    models.push_back(make_model("torus" + std::to_string(i), shapes::rough_torus(2.0 + i), 1000));
    models.push_back(make_model("sphere" + std::to_string(i), shapes::icosphere(4, 1.0 + i), 500));
  }
  return models;
}

TriangleMesh posed(const BenchModel& model, const kernels::Similarity& pose) {
  TriangleMesh mesh = model.fine;
  bench::move(mesh, pose);
  return mesh;
}

TEST(DropHeap, LaysObjectsOnTheFloorAndOnOneAnother) {
  const BenchModels models = six_models();
  const std::vector<std::size_t> objects = {0, 1, 2, 3, 4};
  bench::Random random = bench::random(1, 0, "heap");
  const std::vector<PlacedObject> heap = drop_heap(models, objects, random);
  ASSERT_EQ(heap.size(), objects.size());
  TriangleMesh below;
  for (const PlacedObject& object : heap) {
    const TriangleMesh mesh = posed(*models[object.model], object.pose);
    const double floor = kernels::bounding_box(mesh.points).min().z();
    const double way = below.points.empty()
                           ? floor
                           : std::min(floor, way_to_contact(mesh, below, Vector3d::UnitZ()));
    EXPECT_GE(way, -1e-9);  // nothing crosses
    EXPECT_LT(way, 0.05);   // and nothing hovers
    bench::append(below, mesh);
  }
}

TEST(DropHeap, ScalesEachModelToTheSameSizeInAllHeaps) {
  const BenchModels models = six_models();
  bench::Random random = bench::random(2, 0, "heap");
  for (const PlacedObject& object : drop_heap(models, std::vector<std::size_t>{3, 1}, random))
    EXPECT_NEAR(object.pose.scale * models[object.model]->diagonal,
                size_in_heaps(models[object.model]->name), 1e-12);
}

TEST(MakeHeapScene, PutsTheSurfaceWhereThePosesSay) {
  const BenchModels models = six_models();
  const Scene scene = make_heap_scene(models, 0, 1);
  ASSERT_GE(scene.objects.size(), 2);
  TriangleMesh all;
  for (const PlacedObject& object : scene.objects)
    bench::append(all, posed(*models[object.model], object.pose));
  const kernels::BuiltSurface built = kernels::build_surface(TriangleMesh(all));
  const kernels::NearestSurface nearest(built.surface);
  for (std::size_t v = 0; v < scene.mesh.points.size(); v += 97)
    EXPECT_LT(nearest.nearest(scene.mesh.points[v] - built.origin).distance, 0.01);
}

TEST(MakeHeapScene, SeesLessThanHalfOfConvexObjectsAndMeasuresClutter) {
  const BenchModels models = six_models();
  for (int number = 0; number < 3; ++number) {
    const Scene scene = make_heap_scene(models, number, 1);
    double seen = 0;
    for (const PlacedObject& object : scene.objects) {
      EXPECT_LT(object.occlusion, 1);
      if (models[object.model]->name == "sphere0") {
        EXPECT_GT(object.occlusion, 0.5);
      }
      seen += 1 - object.clutter;
    }
    // What is not in the sum are triangles between objects.
    EXPECT_LE(seen, 1 + 1e-9);
    EXPECT_GT(seen, 0.9);
  }
}

TEST(MakeHeapScene, IsTheSameForTheSameNumberAndSeed) {
  const BenchModels models = six_models();
  const Scene first = make_heap_scene(models, 4, 1);
  EXPECT_EQ(make_heap_scene(models, 4, 1).mesh.points, first.mesh.points);
  EXPECT_NE(make_heap_scene(models, 4, 2).mesh.points, first.mesh.points);
  EXPECT_TRUE(first.mixed_pixels);
  EXPECT_EQ(first.noise, 0.1);
}

TEST(MakeHeapScene, NeedsSixModels) {
  BenchModels models = six_models();
  models.resize(5);
  EXPECT_THROW(make_heap_scene(models, 0, 1), std::runtime_error);
}

}  // namespace
}  // namespace semigeo::recognition
