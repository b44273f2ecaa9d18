#include "bench/recognition/heap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "bench/support/mesh_changes.hpp"

namespace semigeo::recognition {
namespace {

using Eigen::Vector3d;
using kernels::TriangleMesh;

/// The largest distance of an object's centre from the middle.
constexpr double kScatter = 0.55;
/// Half the width of the grid of heights. Objects stay within it.
constexpr double kHalfWidth = 1.6;
constexpr double kCell = 0.01;
constexpr int kSide = static_cast<int>(2 * kHalfWidth / kCell);

/// Holds a height for each cell of a square grid in x and y.
using Heights = std::vector<double>;

int cell_of(double coordinate) {
  return std::clamp(static_cast<int>((coordinate + kHalfWidth) / kCell), 0, kSide - 1);
}

/// Calls visit(cell, lowest, highest) for cells that a triangle covers, with bounds of its heights
/// in the cell. Each cell that it covers is visited; cells beside it may be, too.
template <typename Visit>
void visit_cells(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Visit& visit) {
  const auto [least_x, most_x] = std::minmax({a.x(), b.x(), c.x()});
  const auto [least_y, most_y] = std::minmax({a.y(), b.y(), c.y()});
  if (most_x - least_x > kCell || most_y - least_y > kCell) {
    const Vector3d ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    visit_cells(a, ab, ca, visit);
    visit_cells(ab, b, bc, visit);
    visit_cells(ca, bc, c, visit);
    visit_cells(ab, bc, ca, visit);
    return;
  }
  const auto [lowest, highest] = std::minmax({a.z(), b.z(), c.z()});
  for (int y = cell_of(least_y); y <= cell_of(most_y); ++y)
    for (int x = cell_of(least_x); x <= cell_of(most_x); ++x)
      visit(static_cast<std::size_t>(y) * kSide + x, lowest, highest);
}

template <typename Visit>
void visit_cells(const TriangleMesh& mesh, const Visit& visit) {
  for (const auto& t : mesh.triangles)
    visit_cells(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], visit);
}

/// Returns how far a mesh can be lowered until it meets the floor or what lies in the heap.
double way_down(const TriangleMesh& mesh, const Heights& heap) {
  double way = std::numeric_limits<double>::infinity();
  visit_cells(mesh, [&](std::size_t cell, double lowest, double) {
    way = std::min(way, lowest - heap[cell]);
  });
  return way;
}

/// Returns a random point of the disc in which centres of objects lie.
Vector3d place_near_middle(bench::Random& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const double radius = kScatter * std::sqrt(share(random));
  const double angle = 2 * std::numbers::pi * share(random);
  return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

}  // namespace

std::vector<PlacedObject> drop_heap(ModelSpan models, std::span<const std::size_t> objects,
                                    bench::Random& random) {
  Heights heap(static_cast<std::size_t>(kSide) * kSide, 0.0);
  std::vector<PlacedObject> placed;
  for (const std::size_t index : objects) {
    const BenchModel& model = *models[index];
    PlacedObject object{.model = index, .pose = {}};
    object.pose.scale = size_in_heaps(model.name) / model.diagonal;
    object.pose.rotation = bench::random_rotation(random);
    object.pose.translation =
        place_near_middle(random) - object.pose.scale * (object.pose.rotation * model.centre);
    TriangleMesh mesh = model.fine;
    bench::move(mesh, object.pose);
    const double way = way_down(mesh, heap);
    object.pose.translation.z() -= way;
    visit_cells(mesh, [&](std::size_t cell, double, double highest) {
      heap[cell] = std::max(heap[cell], highest - way);
    });
    placed.push_back(object);
  }
  return placed;
}

}  // namespace semigeo::recognition
