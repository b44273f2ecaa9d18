#pragma once

#include <cstdint>

#include "kernels/patch/gaussian.hpp"
#include "kernels/patch/savitzky_golay.hpp"

namespace semigeo::kernels {
struct SampledSurface;
}

/// What the sources of one instruction set share with everybody else. This header must not pull in
/// functions that a compiler may emit out of line (Eigen, containers): the linker keeps one copy of
/// each for the whole program, and it must not be one that needs AVX.
namespace semigeo::kernels::lanes {

inline constexpr int kBlock = 64;       ///< The most vertices of a block.
inline constexpr int kLines = 20;       ///< The most half-lines of a patch; a polar one has 16.
inline constexpr int kPolarLines = 16;  ///< The half-lines (rays) of a polar patch.
inline constexpr int kSamples = kTaps * kTaps;  ///< The most samples of a patch.
inline constexpr int kWidest = 16;              ///< The most lanes of any instruction set.
/// The most faces that a half-line can cross: crossings are counted in the upper bits of a line's
/// number, see `LineNumber`.
inline constexpr int kMostCrossings = (1 << 18) - 1;

/// Numbers the samples of all half-lines of a block in one integer: the vertex in the block, the
/// sample on the line, the line, and above them the number of faces crossed so far. One addition
/// counts a sample or a crossing, and one comparison tells the end.
struct LineNumber {
  static constexpr int kVertex = 1;
  static constexpr int kSample = kVertex * kBlock;
  static constexpr int kLine = kSample * kReach;
  static constexpr int kCrossing = kLine * 32;
};
static_assert(LineNumber::kCrossing / LineNumber::kLine >= kLines && kReach == 4);
static_assert(std::int64_t{LineNumber::kCrossing} * (kMostCrossings + 1) <= std::int64_t{1} << 31);

/// Names the half-lines of a semigeodesic patch. Those of the column through sample k of base line
/// b are kFirstColumn + 2 (kReach b + k - 1), upwards (v > 0), and the next, downwards.
enum SemigeodesicLine : std::uint8_t {
  kForward = 0,      ///< The base line, u > 0.
  kBackward = 1,     ///< The base line, u < 0.
  kMiddleUp = 2,     ///< The column through the vertex, v > 0.
  kMiddleDown = 3,   ///< The column through the vertex, v < 0.
  kFirstColumn = 4,  ///< The first of the other 16 half-columns.
};

/// Describes a sampled surface by plain arrays. N vertices, F faces.
struct BlockSurface {
  const float* edges;    ///< (4 F, 4) GeodesicFace: records by half-edge; slot 3 has dots and area.
  const float* points;   ///< (N, 4)
  const float* normals;  ///< (N, 3)
  const float* bulges;   ///< (F, 3, 3) and one number more. Null if faces are flat.
  const std::int32_t* outgoing;    ///< (N)
  int max_crossings;               ///< At most `kMostCrossings`.
  const SampledSurface* original;  ///< The same surface, for `ray_from_vertex` and the like.
};

/// Holds the weights that a whole semigeodesic patch is multiplied with.
struct BlockFilters {
  const float* smooth;                    ///< (kTaps) G of (4.5).
  const float* first;                     ///< (kTaps) G' of (4.11).
  const SavitzkyGolayFilters::Tap* taps;  ///< (tap_count)
  int tap_count;
};

/// Describes what is asked of a block of patches.
struct BlockRequest {
  const std::int32_t* first;  ///< (count) First half-edge of each patch; its origin is the vertex.
  int count;                  ///< At most `kBlock`.
  float step;                 ///< Distance of the samples, in the units of the points.
  bool polar;
  const float* ray_directions;  ///< (kPolarLines, 2) Cosine and sine of each ray; polar only.
};

/// Tells what became of a patch.
enum class PatchState : std::uint8_t {
  kWhole,      ///< All samples exist.
  kTruncated,  ///< Lines ended before their last sample; see `PatchBlock::reach`.
  kNone        ///< The first edge has no length.
};

/// Names the rows of `PatchBlock::derivative`.
enum Derivative : std::uint8_t { kR, kSmoothU, kSmoothV, kU, kV, kUU, kUV, kVV, kDerivatives };

/// Holds the patches of a block. Positions are relative to the vertex, as (x, y, z, 0).
struct PatchBlock {
  /// [vertex / 4][sample][vertex mod 4]: sample column * kTaps + row of a semigeodesic patch, or
  /// ray * kReach + distance - 1 of a polar one. Samples that do not exist hold anything.
  alignas(64) float sample[kBlock / 4][kSamples][4][4];
  /// [row][vertex]: what `convolve` and `fit` tell of whole semigeodesic patches.
  alignas(64) float derivative[kDerivatives][kBlock][4];
  std::int8_t reach[kBlock][kLines];  ///< Number of samples of each half-line.
  PatchState state[kBlock];
};

/// Describes a ray as `Ray` does, without Eigen.
struct BlockRay {
  std::int32_t halfedge;
  float x, y, dx, dy;
};

/// Calls `semigeo::kernels::ray_from_vertex` for the rare cases that lanes leave to it.
BlockRay scalar_ray_from_vertex(const BlockSurface& surface, std::int32_t v,
                                const float (&direction)[3]);
/// Calls `semigeo::kernels::perpendiculars` for the rare cases that lanes leave to it, and turns
/// the rays towards their apexes, as lines start.
void scalar_perpendiculars(const BlockSurface& surface, const BlockRay& ray, BlockRay& left,
                           BlockRay& right);

/// Holds rays that wait for free lanes, in structure-of-arrays form. Writers may store a whole
/// vector behind the last ray.
template <int capacity>
struct RayQueue {
  int count = 0;
  alignas(64) std::int32_t halfedge[capacity + kWidest];
  alignas(64) std::int32_t number[capacity + kWidest];  ///< See `LineNumber`.
  alignas(64) float x[capacity + kWidest];
  alignas(64) float y[capacity + kWidest];
  alignas(64) float dx[capacity + kWidest];
  alignas(64) float dy[capacity + kWidest];
  alignas(64) float rest[capacity + kWidest];  ///< Way to the next sample.
};

/// Holds lines that have met a vertex and wait for their way on.
struct VertexQueue {
  int count = 0;
  alignas(64) std::int32_t halfedge[kBlock * kLines + kWidest];
  alignas(64) std::int32_t vertex[kBlock * kLines + kWidest];
  alignas(64) std::int32_t number[kBlock * kLines + kWidest];
  alignas(64) float dx[kBlock * kLines + kWidest];
  alignas(64) float dy[kBlock * kLines + kWidest];
  alignas(64) float rest[kBlock * kLines + kWidest];
};

/// Holds samples that wait for their positions. They are turned into positions when `kFlush` of
/// them wait, while their faces still are in the cache.
struct SampleQueue {
  static constexpr int kFlush = 48;
  static constexpr int kCapacity = kFlush + 4 * kWidest;
  int count = 0;
  alignas(64) std::int32_t halfedge[kCapacity];
  alignas(64) std::int32_t number[kCapacity];
  alignas(64) float x[kCapacity];
  alignas(64) float y[kCapacity];
};

/// The memory that a thread needs to trace blocks, about 220 kB.
struct BlockWorkspace {
  PatchBlock block;
  RayQueue<kBlock * 2> base_lines;
  RayQueue<kBlock * kLines> lines;          ///< All other half-lines.
  RayQueue<kBlock * 2 * kReach> base_rays;  ///< Samples of base lines, each the start of a column.
  VertexQueue vertices;
  SampleQueue samples;
  std::int32_t vertex[kBlock];          ///< Vertex of each patch.
  alignas(16) float centre[kBlock][4];  ///< Its point.
  /// Where a sample goes, in floats from the start of `PatchBlock::sample`: the sum of what its
  /// line and its number on it say, and of what its vertex says.
  std::int32_t sample_place[LineNumber::kCrossing / LineNumber::kSample];
  std::int32_t vertex_place[kBlock];
};

/// Traces the patches of one block and, if they are semigeodesic, convolves them with the filters.
/// The result is in `workspace.block`. There is one such function for each instruction set.
using TraceBlock = void(const BlockSurface& surface, const BlockFilters& filters,
                        const BlockRequest& request, BlockWorkspace& workspace);

}  // namespace semigeo::kernels::lanes

namespace semigeo::kernels::baseline {
lanes::TraceBlock trace_block;
}
namespace semigeo::kernels::avx2 {
lanes::TraceBlock trace_block;
}
namespace semigeo::kernels::avx512 {
lanes::TraceBlock trace_block;
}
