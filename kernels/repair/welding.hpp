#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/surface/connectivity.hpp"
#include "kernels/surface/edge_groups.hpp"

namespace semigeo::kernels {

/// Merges equal points in place, in the order of first appearance. Returns the new index of each
/// point (N).
std::vector<std::int32_t> weld_equal(std::vector<Eigen::Vector3f>& points);

/// Returns the distance, in the units of the points, by which equal points of a file may differ
/// because its numbers are rounded: one step of the last decimal that they show, or `step`, that of
/// their precision, whichever is longer. Only points that are `used` count.
double rounding_of(std::span<const Eigen::Vector3d> points, const std::vector<bool>& used,
                   double step);

/// Closes gaps whose two sides lie within `distance` of each other: the vertices of a boundary edge
/// are merged into those of another boundary edge that runs the other way. A vertex that is on no
/// boundary, and an edge that has no such partner, stay as they are, so that nothing is joined
/// across a thin wall. Nothing is merged if the boundary's edges are not `least_edge` times as
/// long, in the mean. Renames the vertices of `triangles`, whose edges are `groups`, and returns
/// the number of merged ones. The cost is linear.
std::int64_t close_gaps(std::vector<Triangle>& triangles, const EdgeGroups& groups,
                        std::span<const Eigen::Vector3f> points, double distance,
                        double least_edge);

}  // namespace semigeo::kernels
