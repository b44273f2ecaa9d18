#pragma once

namespace semigeo::kernels {

/// The distance from a corner, in barycentric coordinates, below which a point is moved onto it
/// (thesis 5.2.3).
inline constexpr float kSnap = 1e-4f;
/// The number of faces after which a half-line ends, unless its mesh says otherwise: the mesh is
/// far finer there than its mean edge.
inline constexpr int kMaxCrossings = 400;
/// The number of faces of a vertex beyond which a half-line ends there: to find the way round the
/// hub of a fan of 100,000 faces would cost as much as a whole scan.
inline constexpr int kMaxFan = 1024;
/// The slack, as a share of the lengths involved, within which a normal plane counts as passing
/// through an edge.
inline constexpr float kOnPlane = 1e-6f;

}  // namespace semigeo::kernels
