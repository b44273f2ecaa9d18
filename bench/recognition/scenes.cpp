#include "bench/recognition/scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

#include "bench/recognition/touching.hpp"
#include "bench/support/chance.hpp"
#include "bench/support/mesh_changes.hpp"
#include "bench/support/quadric_decimation.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::recognition {
namespace {

using kernels::Similarity;
using kernels::TriangleMesh;

constexpr std::array kKinds = {
    SceneKind{.name = "A", .says = "as it is"},
    SceneKind{.name = "B", .says = "60 % removed", .removed = 0.6},
    SceneKind{.name = "C", .says = "re-digitised", .vertices_left = 0.6},
    SceneKind{.name = "D", .says = "C, half removed", .vertices_left = 0.6, .removed = 0.5},
    SceneKind{.name = "E", .says = "C, noise 0.15", .vertices_left = 0.6, .noise = 0.15},
    SceneKind{.name = "F", .says = "three that touch", .objects = 3},
    SceneKind{.name = "H", .says = "2 or 3 copies", .copies = 3},
    SceneKind{.name = "B70", .says = "70 % removed", .removed = 0.7},
    SceneKind{.name = "D70", .says = "C, 70 % removed", .vertices_left = 0.6, .removed = 0.7},
    SceneKind{.name = "E30", .says = "C, noise 0.3", .vertices_left = 0.6, .noise = 0.3},
    SceneKind{.name = "F60", .says = "three of C", .objects = 3, .vertices_left = 0.6},
};

constexpr std::array kThesisPlacements = {
    ThesisPlacement{"brick", 5.0, 30, 30, 30},      ThesisPlacement{"chair", 2.3, 109, 178, 138},
    ThesisPlacement{"bull", 9.9, 332, 258, 40},     ThesisPlacement{"cube", 7.8, 149, 143, 126},
    ThesisPlacement{"dinosaur", 0.9, 201, 69, 355}, ThesisPlacement{"foot", 0.5, 45, 11, 23},
    ThesisPlacement{"head", 0.7, 309, 241, 206},    ThesisPlacement{"leg", 6.3, 34, 120, 275},
    ThesisPlacement{"rider", 0.3, 11, 349, 189},    ThesisPlacement{"phone", 7.0, 92, 286, 211},
    ThesisPlacement{"rabbit", 0.1, 6, 6, 6},        ThesisPlacement{"torus", 1.1, 74, 304, 132},
};

/// The purposes of random numbers. Each has its own sequence.
enum class Chance : std::uint32_t { kOthers, kPlacement, kChange, kSimilarity };

/// The largest factor by which an object of a scene is enlarged or shrunk.
constexpr double kSizeSpread = 1.3;

/// Returns the models of a scene. `first` comes first, and copies of a model follow one another.
std::vector<std::size_t> chosen(const SceneKind& kind, std::size_t models, std::size_t first,
                                bench::Random& random) {
  if (models < static_cast<std::size_t>(kind.objects))
    throw std::runtime_error("too few models for a scene of " + std::to_string(kind.objects));
  std::vector<std::size_t> different = {first};
  while (std::ssize(different) < kind.objects) {
    const auto other = std::uniform_int_distribution<std::size_t>(0, models - 1)(random);
    if (std::ranges::count(different, other) == 0) different.push_back(other);
  }
  std::vector<std::size_t> result;
  for (const std::size_t model : different) {
    const int copies =
        kind.copies < 2 ? 1 : std::uniform_int_distribution<int>(2, kind.copies)(random);
    result.insert(result.end(), copies, model);
  }
  return result;
}

/// Returns a transform that turns a model at random, gives it nearly unit size and puts its centre
/// at the origin.
Similarity comparable(const BenchModel& model, bench::Random& random) {
  Similarity result;
  result.rotation = bench::random_rotation(random);
  result.scale =
      std::pow(kSizeSpread, std::uniform_real_distribution(-1.0, 1.0)(random)) / model.diagonal;
  result.translation = -result.scale * (result.rotation * model.centre);
  return result;
}

/// Returns the transform that applies `first` and then `second`.
Similarity after(const Similarity& second, const Similarity& first) {
  Similarity result;
  result.scale = second.scale * first.scale;
  result.rotation = second.rotation * first.rotation;
  result.translation = second.apply(first.translation);
  return result;
}

}  // namespace

std::span<const SceneKind> scene_kinds() {
  return kKinds;
}

const SceneKind* scene_kind(const std::string& name) {
  const auto at = std::ranges::find(kKinds, name, &SceneKind::name);
  return at == kKinds.end() ? nullptr : &*at;
}

std::span<const ThesisPlacement> thesis_placements() {
  return kThesisPlacements;
}

Similarity similarity_of(const ThesisPlacement& placement) {
  const auto turn = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
  };
  Similarity result;
  result.scale = placement.scale;
  result.rotation = turn(placement.z, Eigen::Vector3d::UnitZ()) *
                    turn(placement.y, Eigen::Vector3d::UnitY()) *
                    turn(placement.x, Eigen::Vector3d::UnitX());
  return result;
}

TriangleMesh changed(const SceneKind& kind, const TriangleMesh& mesh, const bench::Random& random) {
  TriangleMesh result = mesh;
  if (kind.vertices_left < 1)
    result = bench::quadric_decimated(
        mesh, std::llround(kind.vertices_left * static_cast<double>(mesh.points.size())));
  if (kind.removed > 0) bench::remove_ball(result, kind.removed, random);
  if (kind.noise > 0)
    bench::add_noise(result, kind.noise * bench::mean_edge_length(result), random);
  return result;
}

Scene make_scene(const SceneKind& kind, ModelSpan models, std::size_t first, std::uint64_t seed) {
  Scene scene{
      .kind = kind.name, .name = models[first]->name, .seed = seed, .mesh = {}, .objects = {}};
  const std::string name = scene.kind + "/" + scene.name;
  const auto numbers = [&](Chance chance) {
    return bench::random(seed, static_cast<std::uint32_t>(chance), name);
  };
  bench::Random others = numbers(Chance::kOthers);
  bench::Random placement = numbers(Chance::kPlacement);
  const std::vector<std::size_t> objects = chosen(kind, models.size(), first, others);
  for (const std::size_t index : objects) {
    const BenchModel& model = *models[index];
    bench::Random change = numbers(Chance::kChange);
    change.discard(scene.objects.size());
    TriangleMesh mesh = changed(kind, model.mesh, change);
    PlacedObject object{.model = index, .pose = {}};
    if (objects.size() > 1) object.pose = comparable(model, placement);
    bench::move(mesh, object.pose);
    if (!scene.objects.empty()) {
      const Eigen::Vector3d shift = touching_shift(mesh, scene.mesh, placement);
      object.pose.translation += shift;
      for (Eigen::Vector3d& p : mesh.points) p += shift;
    }
    bench::append(scene.mesh, mesh);
    scene.objects.push_back(object);
  }
  bench::Random similarity = numbers(Chance::kSimilarity);
  const Similarity whole = bench::random_similarity(
      kernels::bounding_box(scene.mesh.points).diagonal().norm(), similarity);
  bench::move(scene.mesh, whole);
  for (PlacedObject& object : scene.objects) object.pose = after(whole, object.pose);
  return scene;
}

}  // namespace semigeo::recognition
