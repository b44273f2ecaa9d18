#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "engine/run_context.hpp"
#include "engine/uninitialized_array.hpp"
#include "jobs/stages/part_measures.hpp"
#include "kernels/evolution/evolution.hpp"
#include "kernels/lanes/instruction_set.hpp"
#include "kernels/repair/remeshing.hpp"
#include "kernels/surface/surface.hpp"

namespace semigeo::jobs {

/// Connectivity and lineage of a level, in the order of its rows. Descendants of vertices of level
/// 0 come first, in the order of level 0, then inserted vertices.
struct LevelConnectivity {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> source_vertex;  ///< (N) Vertex of level 0, or -1 if it was inserted.
  std::vector<std::int32_t> part;           ///< (N) Part, numbered by its first vertex.
  std::vector<std::uint8_t> vertex_filled;  ///< (N) 1 = made by filling; empty without marks.
  std::vector<std::uint8_t> face_filled;    ///< (F) 1 = made by filling; empty without marks.
};

/// The fields of one scale level, in the scan's length unit and in the surface's vertex order.
struct LevelFields {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
  std::vector<float> gaussian_curvature;
  std::vector<float> mean_curvature;
  std::vector<float> patch_completeness;
  // Only if `EvolutionOptions::principal` is set: k1 >= k2. Directions are unit vectors or zero.
  std::vector<float> principal_curvature_1;
  std::vector<float> principal_curvature_2;
  std::vector<Eigen::Vector3f> principal_direction_1;
  std::vector<Eigen::Vector3f> principal_direction_2;
  double step = 0;   ///< Sample distance of the patches.
  double scale = 0;  ///< Sigma of the fields: sqrt(variance of the smoothing so far + step^2).
  double mean_edge_length = 0;

  std::int64_t parts = 0;
  kernels::RemeshCounts remeshed;  ///< What was done to the mesh of the level before.
  double shortest_side = 0;        ///< No side and no height is shorter; 0: not remeshed.
  /// Row i of the level is vertex (*stored_order)[i].
  std::shared_ptr<const std::vector<std::int32_t>> stored_order;
  std::optional<LevelConnectivity> connectivity;  ///< Empty if it is that of the level before.
};

/// How the sampling step grows from level to level.
enum class Schedule {
  kUniform,  ///< It does not grow, as in the thesis.
  kOctaves   ///< It grows with the scale: two levels double it. Parts are never rescaled, and the
             ///< mesh is coarsened as the step grows.
};

/// The measure of each part that is restored after a smoothing (5.1).
enum class Rescale {
  kSize,   ///< The radius of gyration or the enclosed volume, whichever needs the smaller factor.
  kEdges,  ///< The mean edge length, as in the thesis.
  kNone    ///< No measure is restored.
};

/// How a surface is evolved.
struct EvolutionOptions {
  bool curved = true;  ///< Patches sample quadratic faces; otherwise flat ones, as in the thesis.
  kernels::Coordinates coordinates = kernels::Coordinates::kSemigeodesic;
  Schedule schedule = Schedule::kUniform;
  Rescale rescale = Rescale::kSize;  ///< Used under `kUniform` only.
  bool remesh = true;      ///< Odd triangles and lost parts are removed after level 0 (5.5).
  bool principal = false;  ///< Principal curvatures are computed as well.
  double step_factor = 1;  ///< Sample distance of level 0, in its mean edge lengths.
  bool coarsen = true;     ///< Under `kOctaves`, remeshing also coarsens the mesh.
};

/// Where vertices and faces of level 0 come from.
struct Origins {
  std::vector<std::int32_t> vertex;  ///< (N) Row of level 0, a permutation; empty if it is i.
  std::vector<std::uint8_t> vertex_filled;  ///< (N) 1 = made by filling; empty without marks.
  std::vector<std::uint8_t> face_filled;    ///< (F)
};

/// Evolves a surface level by level on all workers. The vertices and faces of each part must be one
/// range, as `kernels::reordered` by `kernels::locality_order` leaves them. The internal unit of
/// length is a power of two near the mean edge length, so that squares of lengths stay in the range
/// of single precision, and the coordinates of the scan are restored exactly.
class EvolvingSurface {
 public:
  EvolvingSurface(kernels::Surface surface, const EvolutionOptions& options,
                  const engine::RunContext& context, Origins origins = {});

  /// Computes the fields of the current level. Results do not depend on the number of threads.
  /// Source: thesis 5.3, 5.4, 5.6.
  LevelFields evaluate();

  /// Makes the surface, smoothed by the patches of `evaluate`, the next level. Call it after
  /// `evaluate`. If the options say so, each part is rescaled about its centroid, the mesh is
  /// coarsened as the step grows, and odd triangles and parts on which no patch was valid are
  /// removed, but not the largest part. A surface that collapses completely becomes a triangle or a
  /// tetrahedron. Source: thesis 5.1, 5.4, 5.5.
  void move();

  /// Calls `evaluate`, then `move` if `move` is set, and returns the fields.
  LevelFields advance(bool move);

  std::int64_t vertex_count() const { return mesh_.vertex_count(); }
  /// Returns the mesh of the current level. Its points are in internal units.
  const kernels::LevelMesh& mesh() const { return mesh_; }
  /// Returns the number of scan units in one internal unit.
  double unit() const { return unit_; }
  /// Returns the mean edge length of level 0 in scan units.
  double first_edge_length() const { return first_edge_length_ * unit_; }
  const EvolutionOptions& options() const { return options_; }
  /// Returns the (N) normals of the smoothed surface, unit or zero. Call it between `evaluate` and
  /// `move`.
  const std::vector<Eigen::Vector3f>& smoothed_normals() const { return next_normals_; }
  /// Returns the current level as patches sample it, in internal units. It is a view of this
  /// object.
  kernels::SampledSurface sampled() const;
  /// Returns how the patches of the current level are laid, in internal units.
  kernels::PatchLayout layout() const;
  /// Returns whether the surface has collapsed. Then the mesh only marks its place.
  bool vanished() const { return vanished_; }

 private:
  void set_step(double step);
  void prepare_faces();
  void angle_weighted_normals();
  void sharpen_normals();
  template <typename VertexAt>
  void sharpen(std::int64_t count, const VertexAt& vertex_at, std::vector<std::uint8_t>& truncated);
  double restoring_factor(const PartMeasure& was, const PartMeasure& is) const;
  std::vector<PartMeasure> restore_size();
  std::vector<PartMeasure> coarsen(std::vector<PartMeasure> parts, kernels::RemeshCounts& counts);
  std::vector<PartMeasure> remesh(std::vector<PartMeasure> parts);
  void adopt_mesh();
  LevelConnectivity connectivity() const;
  double edge_limit() const;

  engine::RunContext context_;
  EvolutionOptions options_;
  kernels::InstructionSet instruction_set_;
  kernels::LevelMesh mesh_;  ///< In internal units.
  bool vanished_ = false;
  std::int64_t target_faces_ = 0;             ///< Number of faces that refining maintains.
  std::vector<PartMeasure> part_reference_;   ///< Rescaling restores it; in internal units.
  std::vector<std::uint8_t> part_has_patch_;  ///< 1 = some patch is valid at the current level.
  double unit_ = 1;                           ///< Scan units per internal unit.
  double mean_edge_length_ = 0;               ///< In internal units.
  double first_edge_length_ = 0;              ///< Mean edge length of level 0.
  double first_edge_limit_ = 0;               ///< Longer edges of level 0 are outliers.
  double step_ = 0;                           ///< Sample distance of this level, in internal units.
  double first_step_ = 0;                     ///< Sample distance of level 0.
  int max_crossings_ = kernels::kMaxCrossings;
  double variance_ = 0;  ///< Variance of the smoothing so far, in internal units^2.

  kernels::RemeshCounts remeshed_;  ///< What was done to the mesh of the level before.
  double shortest_side_ = 0;        ///< In internal units.
  std::shared_ptr<const std::vector<std::int32_t>> stored_order_;
  std::optional<LevelConnectivity> connectivity_;  ///< For the fields of the current level.

  std::vector<Eigen::Vector4f> next_points_;
  std::vector<Eigen::Vector3f> next_normals_;
  engine::UninitializedArray<kernels::GeodesicFace> faces_;
  engine::UninitializedArray<kernels::QuadraticFace> curved_;
};

}  // namespace semigeo::jobs
