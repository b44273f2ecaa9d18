#pragma once

#include <Eigen/Geometry>

#include "bench/support/chance.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::bench {

/// The triangles of a surface, in its own coordinates.
kernels::TriangleMesh triangle_mesh(const kernels::Surface& surface);

double area(const kernels::TriangleMesh& mesh);
/// Over the corners of all faces: edges inside count twice, those of a rim once.
double mean_edge_length(const kernels::TriangleMesh& mesh);

void move(kernels::TriangleMesh& mesh, const kernels::Similarity& similarity);

/// Normal noise in every coordinate.
void add_noise(kernels::TriangleMesh& mesh, double sigma, Random random);

/// Removes this share of the vertices, those nearest to a random one, and every face that has one.
/// Source: thesis 6.4. Vertices that keep no face go too, a little more than the share.
void remove_ball(kernels::TriangleMesh& mesh, double share, Random random);

/// Drops vertices without faces; the others keep their order.
void drop_isolated(kernels::TriangleMesh& mesh);

/// Adds the triangles of another mesh.
void append(kernels::TriangleMesh& mesh, const kernels::TriangleMesh& other);

}  // namespace semigeo::bench
