#pragma once

#include <cstdint>

#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::jobs {

/// Returns a sphere of radius 1 with even edges and at least `vertices` vertices: 10 n^2 + 2 for
/// the smallest n that gives so many. It is closed and oriented outwards.
kernels::TriangleMesh even_sphere(std::int64_t vertices);

/// Returns a sphere with bumps and dents whose places depend on `seed`: an object that can be
/// recognised. It has the connectivity of even_sphere(vertices). Two seeds give two objects.
kernels::TriangleMesh boulder(std::int64_t vertices, std::uint64_t seed);

/// Returns a surface that is as awkward as a scan: a boulder of about `vertices` vertices with
/// uneven edges, noise of a tenth of an edge, a rim where it stood, three holes, and two
/// resolutions that meet along a line. The same number gives the same surface.
kernels::TriangleMesh scan_like(std::int64_t vertices);

}  // namespace semigeo::jobs
