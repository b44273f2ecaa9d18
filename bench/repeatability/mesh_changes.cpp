#include "bench/repeatability/mesh_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "bench/support/chance.hpp"
#include "bench/support/isotropic_remeshing.hpp"
#include "bench/support/mesh_changes.hpp"
#include "bench/support/quadric_decimation.hpp"
#include "bench/support/quantile.hpp"
#include "kernels/surface/bounding_box.hpp"

namespace semigeo::repeatability {
namespace {

using kernels::TriangleMesh;
constexpr std::array kCases = {
    Case{.name = "identity", .moved = false},
    Case{.name = "rotated"},
    Case{.name = "decimated", .digitising = Digitising::kDecimated},
    Case{.name = "decimated+noise", .digitising = Digitising::kDecimated, .noise = true},
    Case{.name = "resampled", .digitising = Digitising::kResampled},
    Case{.name = "resampled+noise", .digitising = Digitising::kResampled, .noise = true},
    Case{.name = "noise", .noise = true},
    Case{.name = "cut", .cut = true},
    Case{.name = "decimated+cut", .digitising = Digitising::kDecimated, .cut = true},
};

/// The purposes of random numbers. Each has its own sequence.
enum class Chance : std::uint32_t { kCut, kNoise, kSimilarity };

bench::Random random(std::uint64_t seed, Chance chance, std::string_view name) {
  return bench::random(seed, static_cast<std::uint32_t>(chance), name);
}

/// Returns a plane through the point whose coordinates are the medians of those of the vertices.
Eigen::Hyperplane<double, 3> random_cut(const kernels::Surface& original, std::uint64_t seed) {
  Eigen::Vector3d middle;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    values.reserve(original.points.size());
    for (const auto& p : original.points) values.push_back(p[c]);
    middle[c] = bench::median(values);
  }
  bench::Random numbers = random(seed, Chance::kCut, "");
  return {bench::normal_vector(numbers).normalized(), middle};
}

/// Drops each face that reaches the negative side. Vertices without faces are kept.
void cut(TriangleMesh& mesh, const Eigen::Hyperplane<double, 3>& plane) {
  std::erase_if(mesh.triangles, [&](const std::array<std::int32_t, 3>& t) {
    return std::ranges::any_of(
        t, [&](std::int32_t v) { return plane.signedDistance(mesh.points[v]) < 0; });
  });
}

}  // namespace

std::span<const Case> all_cases() {
  return kCases;
}

MeshChanger::MeshChanger(const kernels::Surface& original, const ChangeOptions& options)
    : original_(original), options_(options), as_is_(bench::triangle_mesh(original)) {}

const TriangleMesh& MeshChanger::digitised(Digitising digitising) {
  const auto vertices = static_cast<double>(original_.vertex_count());
  switch (digitising) {
    case Digitising::kDecimated:
      if (!decimated_)
        decimated_ =
            bench::quadric_decimated(as_is_, std::llround(options_.vertices_left * vertices));
      return *decimated_;
    case Digitising::kResampled:
      if (!resampled_) resampled_ = bench::isotropic_remeshed(original_, original_.vertex_count());
      return *resampled_;
    case Digitising::kAsIs:
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
  result.area = bench::area(result.mesh);
  if (change.noise)
    bench::add_noise(result.mesh, options_.noise * bench::mean_edge_length(result.mesh),
                     random(options_.seed, Chance::kNoise, change.name));
  if (change.moved) {
    bench::Random numbers = random(options_.seed, Chance::kSimilarity, change.name);
    result.similarity =
        bench::random_similarity(kernels::bounding_box(as_is_.points).diagonal().norm(), numbers);
    bench::move(result.mesh, result.similarity);
  }
  return result;
}

}  // namespace semigeo::repeatability
