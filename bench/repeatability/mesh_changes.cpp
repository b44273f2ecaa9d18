#include "bench/repeatability/mesh_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include "bench/support/isotropic_remeshing.hpp"
#include "bench/support/quadric_decimation.hpp"
#include "bench/support/quantile.hpp"

namespace semigeo::repeatability {
namespace {

using kernels::TriangleMesh;
using Random = std::mt19937_64;

constexpr std::array kCases = {
    Case{.name = "identity", .moved = false},
    Case{.name = "rotated"},
    Case{.name = "decimated", .digitising = Digitising::decimated},
    Case{.name = "decimated+noise", .digitising = Digitising::decimated, .noise = true},
    Case{.name = "resampled", .digitising = Digitising::resampled},
    Case{.name = "resampled+noise", .digitising = Digitising::resampled, .noise = true},
    Case{.name = "noise", .noise = true},
    Case{.name = "cut", .cut = true},
    Case{.name = "decimated+cut", .digitising = Digitising::decimated, .cut = true},
};

/// What chance decides; each has numbers of its own.
enum class Chance : std::uint32_t { cut, noise, similarity };

Random random(std::uint64_t seed, Chance chance, std::string_view name) {
  std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(seed),
                                      static_cast<std::uint32_t>(seed >> 32),
                                      static_cast<std::uint32_t>(chance)};
  for (const char c : name) words.push_back(static_cast<unsigned char>(c));
  std::seed_seq sequence(words.begin(), words.end());
  return Random(sequence);
}

Eigen::Vector3d normal_vector(Random& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum +=
        (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]).norm();
  return sum / 2;
}

/// Over the corners of all faces: edges inside count twice, those of a rim once.
double mean_edge_length(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) sum += (mesh.points[t[(i + 1) % 3]] - mesh.points[t[i]]).norm();
  return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

/// A plane through the median of the vertices, coordinate by coordinate.
Eigen::Hyperplane<double, 3> random_cut(const kernels::Surface& original, std::uint64_t seed) {
  Eigen::Vector3d middle;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    values.reserve(original.points.size());
    for (const auto& p : original.points) values.push_back(p[c]);
    middle[c] = bench::median(values);
  }
  Random numbers = random(seed, Chance::cut, "");
  return {normal_vector(numbers).normalized(), middle};
}

/// Drops every face that reaches the negative side; vertices without faces stay.
void cut(TriangleMesh& mesh, const Eigen::Hyperplane<double, 3>& plane) {
  std::erase_if(mesh.triangles, [&](const std::array<std::int32_t, 3>& t) {
    return std::ranges::any_of(
        t, [&](std::int32_t v) { return plane.signedDistance(mesh.points[v]) < 0; });
  });
}

void add_noise(TriangleMesh& mesh, double sigma, Random random) {
  for (Eigen::Vector3d& p : mesh.points) p += sigma * normal_vector(random);
}

/// Any rotation, a factor between 1/2 and 2, and a shift of about the size of the object.
Similarity random_similarity(const kernels::Surface& original, Random random) {
  Eigen::AlignedBox3f box;
  for (const auto& p : original.points) box.extend(p);
  Similarity result;
  std::normal_distribution<double> normal;
  std::array<double, 4> q{};
  for (double& x : q) x = normal(random);
  result.rotation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  result.scale = std::exp2(std::uniform_real_distribution(-1.0, 1.0)(random));
  result.shift = static_cast<double>(box.diagonal().norm()) * normal_vector(random);
  return result;
}

}  // namespace

std::span<const Case> all_cases() {
  return kCases;
}

MeshChanger::MeshChanger(const kernels::Surface& original, const ChangeOptions& options)
    : original_(original), options_(options) {
  as_is_.triangles = original.triangles;
  for (const auto& p : original.points) as_is_.points.push_back(p.cast<double>());
}

const TriangleMesh& MeshChanger::digitised(Digitising digitising) {
  const auto vertices = static_cast<double>(original_.vertex_count());
  switch (digitising) {
    case Digitising::decimated:
      if (!decimated_)
        decimated_ =
            bench::quadric_decimated(as_is_, std::llround(options_.vertices_left * vertices));
      return *decimated_;
    case Digitising::resampled:
      if (!resampled_) resampled_ = bench::isotropic_remeshed(original_, original_.vertex_count());
      return *resampled_;
    case Digitising::as_is:
      break;
  }
  return as_is_;
}

ChangedMesh MeshChanger::changed(const Case& change) {
  ChangedMesh result{.mesh = digitised(change.digitising), .similarity = {}, .area = 0, .cut = {}};
  if (change.cut) {
    result.cut = random_cut(original_, options_.seed);
    cut(result.mesh, *result.cut);
  }
  result.area = area(result.mesh);
  if (change.noise)
    add_noise(result.mesh, options_.noise * mean_edge_length(result.mesh),
              random(options_.seed, Chance::noise, change.name));
  if (change.moved) {
    result.similarity =
        random_similarity(original_, random(options_.seed, Chance::similarity, change.name));
    for (Eigen::Vector3d& p : result.mesh.points) p = result.similarity.apply(p);
  }
  return result;
}

}  // namespace semigeo::repeatability
