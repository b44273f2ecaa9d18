#pragma once

#include <cstdint>

#include "kernels/surface/triangle_mesh.hpp"

/// Analytic test surfaces, oriented outwards. Shared by tests and benchmarks.
namespace semigeo::shapes {

using kernels::TriangleMesh;

/// Icosahedron subdivided `levels` times, on a sphere about the origin: 10 * 4^levels + 2 vertices.
TriangleMesh icosphere(int levels, double radius = 1);

/// Torus about the z axis, `nu` x `nv` vertices. `unevenness` in [0, 1) moves the grid lines so
/// that edge lengths vary by about (1 + unevenness) / (1 - unevenness), and shears them.
TriangleMesh torus(double major, double minor, int nu, int nv, double unevenness = 0);

/// An uneven torus with noise, of radii `size` and 0.4 `size`: nothing about it is symmetric.
TriangleMesh rough_torus(double size = 1);

/// Open cylinder about the z axis from z = -height / 2.
TriangleMesh cylinder(double radius, double height, int around, int along);

/// Square [-size / 2, size / 2]^2 with n x n cells and alternating diagonals; z = bend (x^2 - y^2)
/// / 2.
TriangleMesh saddle(double size, int n, double bend = 1);
TriangleMesh plane(double size, int n);

/// Cube of edge length `size` about the origin, n x n cells a side: 6 n^2 + 2 vertices, of which
/// the thesis' cube (6.1) is n = 4.
TriangleMesh cube(double size, int n);

/// Upper half of an icosphere, with the rim that the triangulation leaves.
TriangleMesh hemisphere(int levels, double radius = 1);

/// Adds to every coordinate noise that is uniform in +-sqrt(3) * sigma. Same seed, same noise.
void add_noise(TriangleMesh& mesh, double sigma, std::uint64_t seed);

}  // namespace semigeo::shapes
