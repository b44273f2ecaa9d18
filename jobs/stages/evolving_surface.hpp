#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/evolution.hpp"
#include "kernels/surface.hpp"

namespace semigeo::jobs {

/// The fields of one scale level, in the scan's length unit and in the surface's vertex order.
struct LevelFields {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> gaussian_curvature;
  std::vector<float> mean_curvature;
  std::vector<float> patch_completeness;
  /// If asked for: k1 >= k2, and their directions, unit or zero.
  std::vector<float> principal_curvature_1;
  std::vector<float> principal_curvature_2;
  std::vector<Eigen::Vector3f> principal_direction_1;
  std::vector<Eigen::Vector3f> principal_direction_2;
  double step = 0;   ///< sample distance of the patches
  double scale = 0;  ///< sigma of the fields: sqrt(variance of the smoothing so far + step^2)
  double mean_edge_length = 0;
};

/// How the sampling step grows from level to level.
enum class Schedule {
  uniform,  ///< not at all, as in the thesis
  octaves   ///< with the scale reached: two levels double it; parts are never rescaled
};

struct EvolutionOptions {
  bool curved = true;  ///< sample quadratic faces; else flat ones, as the thesis does
  kernels::Coordinates coordinates = kernels::Coordinates::semigeodesic;
  Schedule schedule = Schedule::uniform;
  bool rescale = true;     ///< under `uniform` give parts their mean edge length back (5.1)
  bool principal = false;  ///< principal curvatures as well
  double step_factor = 1;  ///< sample distance of level 0 in its mean edge lengths
};

/// Evolves a surface level by level on all workers: kernels for one vertex go in, ranges of
/// vertices come out. The vertices and faces of each part must be one range, as
/// `kernels::reordered` by `kernels::locality_order` leaves them. Inside, lengths are multiples of
/// a power of two near the mean edge length, so that no square of a length leaves single precision,
/// and the scan's own coordinates come back exactly.
class EvolvingSurface {
 public:
  EvolvingSurface(kernels::Surface surface, const EvolutionOptions& options,
                  const engine::RunContext& context);

  /// Curvature of the current level; if `move`, the surface is then smoothed by the same patches,
  /// if so wanted each part is rescaled about its centroid to its first mean edge
  /// length, and becomes the next level. Results do not depend on the number of threads. Source:
  /// thesis 5.1, 5.3 - 5.6.
  LevelFields advance(bool move);

  std::int64_t vertex_count() const { return static_cast<std::int64_t>(points_.size()); }

 private:
  struct PartMeasure;
  /// Faces of one part that one task measures.
  struct FaceBlock {
    std::int32_t part;
    std::int32_t begin;
    std::int32_t end;
  };

  kernels::SampledSurface sampled() const;
  kernels::PatchLayout layout() const;
  void set_step(double step);
  void prepare_faces();
  void angle_weighted_normals();
  void sharpen_normals();
  template <typename VertexAt>
  void sharpen(std::int64_t count, const VertexAt& vertex_at, std::vector<std::uint8_t>& truncated);
  std::vector<PartMeasure> measure_parts() const;
  double restore_size();

  engine::RunContext context_;
  EvolutionOptions options_;
  kernels::Surface surface_;  ///< connectivity; its points are dropped
  std::vector<FaceBlock> face_blocks_;
  std::vector<double> part_edge_length_;  ///< of level 0
  double unit_ = 1;                       ///< scan units per internal unit
  double mean_edge_length_ = 0;           ///< internal units
  double step_ = 0;                       ///< sample distance of this level, internal units
  double first_step_ = 0;                 ///< of level 0
  int max_crossings_ = kernels::kMaxCrossings;
  double variance_ = 0;  ///< of the smoothing so far, internal units^2

  std::vector<Eigen::Vector4f> points_;
  std::vector<Eigen::Vector4f> next_points_;
  std::vector<Eigen::Vector3f> normals_;
  std::vector<Eigen::Vector3f> next_normals_;
  std::vector<kernels::GeodesicFace> faces_;
  std::vector<kernels::QuadraticFace> curved_;
};

}  // namespace semigeo::jobs
