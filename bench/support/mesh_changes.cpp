#include "bench/support/mesh_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace semigeo::bench {

using kernels::TriangleMesh;

TriangleMesh triangle_mesh(const kernels::Surface& surface) {
  TriangleMesh mesh;
  mesh.triangles = surface.triangles;
  mesh.points.reserve(surface.points.size());
  for (const auto& p : surface.points) mesh.points.push_back(p.cast<double>());
  return mesh;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    sum +=
        (mesh.points[t[1]] - mesh.points[t[0]]).cross(mesh.points[t[2]] - mesh.points[t[0]]).norm();
  return sum / 2;
}

double mean_edge_length(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) sum += (mesh.points[t[(i + 1) % 3]] - mesh.points[t[i]]).norm();
  return sum / (3 * static_cast<double>(mesh.triangles.size()));
}

void move(TriangleMesh& mesh, const kernels::Similarity& similarity) {
  for (Eigen::Vector3d& p : mesh.points) p = similarity.apply(p);
}

void add_noise(TriangleMesh& mesh, double sigma, Random random) {
  for (Eigen::Vector3d& p : mesh.points) p += sigma * normal_vector(random);
}

void remove_ball(TriangleMesh& mesh, double share, Random random) {
  const auto count = static_cast<std::int64_t>(mesh.points.size());
  if (count == 0) return;
  const Eigen::Vector3d centre =
      mesh.points[std::uniform_int_distribution<std::int64_t>(0, count - 1)(random)];
  std::vector<std::int64_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  const auto distance = [&](std::int64_t v) { return (mesh.points[v] - centre).squaredNorm(); };
  std::ranges::sort(order, [&](std::int64_t a, std::int64_t b) {
    return std::pair(distance(a), a) < std::pair(distance(b), b);
  });
  std::vector<char> removed(count, 0);
  const auto taken = std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(count));
  for (std::int64_t i = 0; i < taken; ++i) removed[order[i]] = 1;
  std::erase_if(mesh.triangles, [&](const std::array<std::int32_t, 3>& t) {
    return std::ranges::any_of(t, [&](std::int32_t v) { return removed[v] != 0; });
  });
  drop_isolated(mesh);
}

void drop_isolated(TriangleMesh& mesh) {
  std::vector<std::int32_t> place(mesh.points.size(), -1);
  for (const auto& t : mesh.triangles)
    for (const std::int32_t v : t) place[v] = 0;
  std::int32_t kept = 0;
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] < 0) continue;
    mesh.points[kept] = mesh.points[v];
    place[v] = kept++;
  }
  mesh.points.resize(kept);
  for (auto& t : mesh.triangles)
    for (std::int32_t& v : t) v = place[v];
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::int32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (auto t : other.triangles) {
    for (std::int32_t& v : t) v += offset;
    mesh.triangles.push_back(t);
  }
}

}  // namespace semigeo::bench
