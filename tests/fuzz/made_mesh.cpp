#include "tests/fuzz/made_mesh.hpp"

#include <cmath>
#include <numbers>

namespace semigeo::fuzz {
namespace {

using kernels::TriangleMesh;

/// Returns a number from -1 to 1 in steps of 1/128.
double fraction(Numbers& numbers) {
  return (static_cast<double>(numbers.byte()) - 128) / 128;
}

TriangleMesh soup(Numbers& numbers) {
  TriangleMesh mesh;
  const unsigned points = 3 + numbers.below(62);
  const unsigned faces = 1 + numbers.below(128);
  for (unsigned i = 0; i < points; ++i) {
    const double x = fraction(numbers), y = fraction(numbers), z = fraction(numbers);
    mesh.points.emplace_back(x, y, z);
  }
  for (unsigned i = 0; i < faces; ++i) {
    auto& triangle = mesh.triangles.emplace_back();
    for (std::int32_t& corner : triangle) corner = static_cast<std::int32_t>(numbers.below(points));
  }
  return mesh;
}

/// Adds the two triangles of a cell of `columns` points in a row. The column after the last is the
/// first.
void add_cell(TriangleMesh& mesh, unsigned row, unsigned column, unsigned columns) {
  const auto at = [&](unsigned r, unsigned c) {
    return static_cast<std::int32_t>(r * columns + c % columns);
  };
  mesh.triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
  mesh.triangles.push_back({at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
}

TriangleMesh grid(Numbers& numbers) {
  TriangleMesh mesh;
  const unsigned side = 3 + numbers.below(7);
  const double height = fraction(numbers);
  for (unsigned r = 0; r < side; ++r)
    for (unsigned c = 0; c < side; ++c) mesh.points.emplace_back(r, c, height * fraction(numbers));
  for (unsigned r = 0; r + 1 < side; ++r)
    for (unsigned c = 0; c + 1 < side; ++c) add_cell(mesh, r, c, side);
  return mesh;
}

TriangleMesh ball(Numbers& numbers) {
  TriangleMesh mesh;
  const unsigned rows = 3 + numbers.below(7);
  const unsigned columns = 3 + numbers.below(8);
  const double roughness = fraction(numbers);
  for (unsigned r = 0; r < rows; ++r)
    for (unsigned c = 0; c < columns; ++c) {
      const double theta = std::numbers::pi * (r + 0.5) / rows;
      const double phi = 2 * std::numbers::pi * c / columns;
      const double radius = 1 + roughness * fraction(numbers);
      mesh.points.emplace_back(radius * std::sin(theta) * std::cos(phi),
                               radius * std::sin(theta) * std::sin(phi), radius * std::cos(theta));
    }
  for (unsigned r = 0; r + 1 < rows; ++r)
    for (unsigned c = 0; c < columns; ++c) add_cell(mesh, r, c, columns);
  for (const unsigned pole : {0U, rows - 1}) {
    const auto first = static_cast<std::int32_t>(pole * columns);
    for (unsigned c = 1; c + 1 < columns; ++c) {
      const auto a = first + static_cast<std::int32_t>(c);
      if (pole == 0) mesh.triangles.push_back({first, a + 1, a});
      if (pole != 0) mesh.triangles.push_back({first, a, a + 1});
    }
  }
  return mesh;
}

/// Changes a face or a point.
void edit(TriangleMesh& mesh, Numbers& numbers) {
  const unsigned kind = numbers.below(6);
  const std::size_t face = numbers.byte() % mesh.triangles.size();
  const std::size_t point = numbers.byte() % mesh.points.size();
  auto& triangle = mesh.triangles[face];
  if (kind == 0) mesh.triangles.push_back(triangle);
  if (kind == 1) std::swap(triangle[0], triangle[1]);
  if (kind == 2) triangle[numbers.below(3)] = static_cast<std::int32_t>(point);
  if (kind == 3 && mesh.triangles.size() > 1)
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(face));
  if (kind == 4) mesh.points[point] = mesh.points[numbers.byte() % mesh.points.size()];
  if (kind == 5)
    mesh.points[point][numbers.below(3)] = std::ldexp(fraction(numbers), numbers.below(80));
}

/// Moves and scales all points.
void place(TriangleMesh& mesh, Numbers& numbers) {
  constexpr double kScales[] = {1, 1e-3, 1e6, 1e-30, 1e25, 1e-12};
  constexpr double kOffsets[] = {0, 1e6, -1e9, 1e20};
  const double scale = kScales[numbers.below(6)];
  const double offset = kOffsets[numbers.below(4)];
  for (Eigen::Vector3d& point : mesh.points) point = (point.array() * scale + offset).matrix();
}

}  // namespace

TriangleMesh made_mesh(Numbers& numbers) {
  const unsigned kind = numbers.below(3);
  const bool placed = numbers.below(4) == 1;
  const unsigned edits = numbers.below(24);
  TriangleMesh mesh = kind == 0 ? soup(numbers) : kind == 1 ? grid(numbers) : ball(numbers);
  if (placed) place(mesh, numbers);
  for (unsigned i = 0; i < edits && !numbers.empty(); ++i) edit(mesh, numbers);
  return mesh;
}

}  // namespace semigeo::fuzz
