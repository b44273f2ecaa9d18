#include "bench/recognition/heap_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/recognition/heap.hpp"
#include "bench/recognition/virtual_scanner.hpp"
#include "bench/support/mesh_changes.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::recognition {
namespace {

using Eigen::Vector3d;
using kernels::Similarity;
using kernels::TriangleMesh;

/// The purposes of random numbers. Each has its own sequence.
enum class Chance : std::uint32_t { kObjects, kHeap, kCamera, kErrors };

constexpr std::array kNoise = {0.0, 0.1, 0.25};  ///< In pixels.
constexpr double kQuantum = 0.05;                ///< In pixels.
constexpr double kMixed = 0.5;                   ///< Share of the pixels beside depth jumps.
constexpr int kFewestObjects = 3;
constexpr int kMostObjects = 6;
/// The camera is at least so high above the floor: the sine of the angle.
constexpr double kLowest = 0.15;

std::vector<std::size_t> chosen(std::size_t models, bench::Random& random) {
  if (models < kMostObjects)
    throw std::runtime_error("too few models for a heap of " + std::to_string(kMostObjects));
  std::vector<std::size_t> all(models);
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::ranges::shuffle(all, random);
  all.resize(std::uniform_int_distribution<std::size_t>(kFewestObjects, kMostObjects)(random));
  return all;
}

/// Returns the transform into the frame of a camera that looks at the middle of the box from a
/// random direction above it, two to four radii away.
Similarity random_view(const Eigen::AlignedBox3d& box, bench::Random& random) {
  const double z = std::uniform_real_distribution(kLowest, 1.0)(random);
  const double angle = std::uniform_real_distribution(0.0, 2 * std::numbers::pi)(random);
  const double flat = std::sqrt(1 - z * z);
  const Vector3d direction(flat * std::cos(angle), flat * std::sin(angle), z);
  const double distance =
      std::uniform_real_distribution(2.0, 4.0)(random) * box.diagonal().norm() / 2;
  const Eigen::Quaterniond upright =
      Eigen::Quaterniond::FromTwoVectors(direction, Vector3d::UnitZ());
  Similarity view;
  view.rotation = upright.toRotationMatrix();
  view.translation = -(view.rotation * (box.center() + distance * direction));
  return view;
}

/// Fills in how much of each object is seen, and how much of what is seen it is.
void measure(const std::vector<TriangleMesh>& objects, const VirtualScan& clean, Scene& scene) {
  const std::vector<double> areas = areas_of_objects(clean, objects.size());
  const double seen = bench::area(clean.mesh);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    scene.objects[i].occlusion = 1 - areas[i] / bench::area(objects[i]);
    scene.objects[i].clutter = 1 - areas[i] / seen;
  }
  std::erase_if(scene.objects, [](const PlacedObject& object) { return object.clutter >= 1; });
}

}  // namespace

Scene make_heap_scene(ModelSpan models, int number, std::uint64_t seed) {
  const std::string name = "heap-" + std::to_string(number);
  const auto numbers = [&](Chance chance) {
    return bench::random(seed, static_cast<std::uint32_t>(chance), name);
  };
  bench::Random of_objects = numbers(Chance::kObjects), of_heap = numbers(Chance::kHeap),
                of_camera = numbers(Chance::kCamera), of_errors = numbers(Chance::kErrors);
  Scene scene{.kind = kHeap, .name = name, .seed = seed, .mesh = {}, .objects = {}};
  scene.objects = drop_heap(models, chosen(models.size(), of_objects), of_heap);
  std::vector<TriangleMesh> objects;
  Eigen::AlignedBox3d box;
  for (const PlacedObject& object : scene.objects) {
    bench::move(objects.emplace_back(models[object.model]->fine), object.pose);
    box.extend(kernels::bounding_box(objects.back().points));
  }
  const Similarity view = random_view(box, of_camera);
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    bench::move(objects[i], view);
    scene.objects[i].pose = view * scene.objects[i].pose;
    points.insert(points.end(), objects[i].points.begin(), objects[i].points.end());
  }
  const Camera camera =
      camera_for(points, std::uniform_int_distribution<std::int64_t>(180, 300)(of_camera));
  DepthImage image = render(objects, camera);
  measure(objects, triangulated(image, camera), scene);
  scene.noise = kNoise[static_cast<std::size_t>(number) % kNoise.size()];
  scene.mixed_pixels = number / std::ssize(kNoise) % 2 == 1;
  disturb(image, camera,
          {.noise = scene.noise, .quantum = kQuantum, .mixed = scene.mixed_pixels ? kMixed : 0},
          of_errors);
  scene.mesh = triangulated(image, camera).mesh;
  return scene;
}

}  // namespace semigeo::recognition
