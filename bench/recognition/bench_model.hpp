#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/repair/surface_builder.hpp"
#include "kernels/surface/nearest_surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

/// An object that a library knows. Coordinates are those of its file.
struct BenchModel {
  std::string name;
  kernels::TriangleMesh mesh;   ///< repaired, decimated
  kernels::BuiltSurface built;  ///< the same
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double diagonal = 0;                               ///< of the bounding box
  std::unique_ptr<kernels::NearestSurface> nearest;  ///< of `built`, relative to its origin
};
using BenchModels = std::vector<std::unique_ptr<BenchModel>>;
using ModelSpan = std::span<const std::unique_ptr<BenchModel>>;

/// Repairs the mesh and, if it has more than `most_vertices` (0: any number), decimates it by
/// quadrics. Nothing if no face is left. Throws std::runtime_error if OpenMesh cannot hold it.
std::unique_ptr<BenchModel> make_model(std::string name, kernels::TriangleMesh mesh,
                                       std::int64_t most_vertices);

/// Repaired, and decimated to at most so many vertices (0: any number).
kernels::TriangleMesh repaired(kernels::TriangleMesh mesh, std::int64_t most_vertices);

struct ModelChoice {
  std::vector<std::filesystem::path> places;  ///< files, and folders searched for scans
  std::int64_t most_vertices = 5000;
  std::int64_t most_models = 0;  ///< 0: all
};

struct SkippedModel {
  std::filesystem::path path;
  std::string why;
};

/// The closed meshes among the files, in the order of their paths within each place, named by their
/// stems; a stem that comes again gets a number.
BenchModels read_models(const ModelChoice& choice, std::vector<SkippedModel>& skipped);

}  // namespace semigeo::recognition
