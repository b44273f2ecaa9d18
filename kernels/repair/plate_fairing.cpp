#include "kernels/repair/plate_fairing.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace semigeo::kernels {
namespace {

// Cotangents are limited to this interval. Others would give negative weights, or let single
// slivers dominate.
constexpr double kLeastCotangent = 0.05;
constexpr double kLargestCotangent = 5;
/// The greatest distance from the centroid, in radii of the mesh, that a vertex may have.
constexpr double kReach = 3;

std::vector<double> vertex_areas(const std::vector<Eigen::Vector3d>& points,
                                 std::span<const Triangle> triangles) {
  std::vector<double> area(points.size(), 0.0);
  for (const Triangle& t : triangles) {
    const double twice = (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
    for (const std::int32_t v : t) area[v] += twice / 6;
  }
  double mean = 0;
  for (const double a : area) mean += a / static_cast<double>(area.size());
  // One vertex among slivers must not outweigh all the others.
  for (double& a : area) a = std::max(a, 0.01 * mean);
  return area;
}

double limited_cotangent(const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
  const double sine = u.cross(v).norm();
  if (!(sine > 0)) return kLargestCotangent;
  return std::clamp(u.dot(v) / sine, kLeastCotangent, kLargestCotangent);
}

/// Holds linear equations for the places of the vertices that move.
struct Equations {
  Eigen::SparseMatrix<double> matrix;              ///< (rows, moving vertices) Left side.
  Eigen::Matrix<double, Eigen::Dynamic, 3> right;  ///< (rows, 3) Right side.
};

/// Returns the equations. `column` holds the column of each moving vertex and -1 for the held ones;
/// `moving` is the number of columns.
Equations plate_equations(const std::vector<Eigen::Vector3d>& points,
                          std::span<const Eigen::Vector3d> targets,
                          std::span<const PlateRole> roles, std::span<const Triangle> triangles,
                          const std::vector<std::int32_t>& column, std::int32_t moving,
                          double wave_length) {
  const std::vector<double> area = vertex_areas(points, triangles);
  Equations equations;
  equations.right.setZero(2 * moving, 3);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * triangles.size() + moving);
  const auto add = [&](std::int32_t row, std::int32_t vertex, double value) {
    if (column[vertex] >= 0)
      entries.emplace_back(row, column[vertex], value);
    else
      equations.right.row(row) -= value * points[vertex].transpose();
  };
  // Each Laplacian is multiplied by the square root of the area that it stands for.
  for (const Triangle& t : triangles)
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = t[i];
      const std::int32_t b = t[(i + 1) % 3];
      const Eigen::Vector3d& tip = points[t[(i + 2) % 3]];
      const double half = 0.5 * limited_cotangent(points[a] - tip, points[b] - tip);
      for (const auto& [center, other] : {std::pair{a, b}, std::pair{b, a}}) {
        if (column[center] < 0) continue;
        const double scale = half / std::sqrt(area[center]);
        add(column[center], center, -scale);
        add(column[center], other, scale);
      }
    }
  const double stiffness = std::pow(2 * std::numbers::pi / wave_length, 2);
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (roles[v] != PlateRole::kTied) continue;
    const double scale = stiffness * std::sqrt(area[v]);
    entries.emplace_back(moving + column[v], column[v], scale);
    equations.right.row(moving + column[v]) = scale * targets[v].transpose();
  }
  equations.matrix.resize(2 * moving, moving);
  equations.matrix.setFromTriplets(entries.begin(), entries.end());
  return equations;
}

/// Tells whether all places are finite and within kReach of the mesh.
bool plausible(const Eigen::MatrixXd& places, const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& p : points) centroid += p / static_cast<double>(points.size());
  double radius = 0;
  for (const auto& p : points) radius = std::max(radius, (p - centroid).norm());
  for (Eigen::Index k = 0; k < places.rows(); ++k)
    if (!((places.row(k).transpose() - centroid).norm() <= kReach * radius)) return false;
  return true;
}

}  // namespace

bool fair_plate(std::vector<Eigen::Vector3d>& points, std::span<const Eigen::Vector3d> targets,
                std::span<const PlateRole> roles, std::span<const Triangle> triangles,
                double wave_length) {
  std::vector<std::int32_t> column(points.size(), -1);
  std::int32_t moving = 0;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (roles[v] != PlateRole::kHeld) column[v] = moving++;
  if (moving == 0) return true;
  const Equations equations =
      plate_equations(points, targets, roles, triangles, column, moving, wave_length);
  const Eigen::SparseMatrix<double> transposed = equations.matrix.transpose();
  const Eigen::SparseMatrix<double> normal = transposed * equations.matrix;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(normal);
  if (factors.info() != Eigen::Success) return false;
  const Eigen::MatrixXd right = transposed * equations.right;
  const Eigen::MatrixXd places = factors.solve(right);
  if (!plausible(places, points)) return false;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (column[v] >= 0) points[v] = places.row(column[v]).transpose();
  return true;
}

}  // namespace semigeo::kernels
