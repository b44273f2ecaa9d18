#pragma once

#include <Eigen/Geometry>

#include "bench/support/chance.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// Returns the triangles of a surface, in its own coordinates.
kernels::TriangleMesh triangle_mesh(const kernels::Surface& surface);

/// Returns the area of all faces.
double area(const kernels::TriangleMesh& mesh);
/// Returns the mean length of the sides of all faces. Inner edges count twice, boundary edges once.
double mean_edge_length(const kernels::TriangleMesh& mesh);

/// Applies a similarity to all points.
void move(kernels::TriangleMesh& mesh, const kernels::Similarity& similarity);

/// Adds normal noise to every coordinate. `sigma` is in the units of the points.
void add_noise(kernels::TriangleMesh& mesh, double sigma, Random random);

/// Removes the vertices nearest to a random one, this share of all, and every face that has one of
/// them. Vertices without faces are removed as well, so that a little more than the share is gone.
/// Source: thesis 6.4.
void remove_ball(kernels::TriangleMesh& mesh, double share, Random random);

/// Removes vertices without faces. The others keep their order.
void drop_isolated(kernels::TriangleMesh& mesh);

/// Appends the points and triangles of another mesh.
void append(kernels::TriangleMesh& mesh, const kernels::TriangleMesh& other);

}  // namespace semigeo::bench
