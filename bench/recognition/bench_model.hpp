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

/// Describes an object of a library. Coordinates are those of its file.
struct BenchModel {
  std::string name;
  kernels::TriangleMesh fine;   ///< The mesh after repair.
  kernels::TriangleMesh mesh;   ///< The mesh after repair and decimation.
  kernels::BuiltSurface built;  ///< The surface of that mesh.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double diagonal = 0;                               ///< Diagonal of the bounding box.
  std::unique_ptr<kernels::NearestSurface> nearest;  ///< Finds points of `built`.
};
/// Holds models that keep their addresses.
using BenchModels = std::vector<std::unique_ptr<BenchModel>>;
/// Refers to models that somebody else owns.
using ModelSpan = std::span<const std::unique_ptr<BenchModel>>;

/// Makes a model of a mesh: repairs it and decimates it by quadrics to at most `most_vertices`
/// vertices (0: no limit). Returns null if no face is left. Throws std::runtime_error if OpenMesh
/// cannot hold the mesh.
std::unique_ptr<BenchModel> make_model(std::string name, kernels::TriangleMesh mesh,
                                       std::int64_t most_vertices);

/// Returns the mesh after repair and decimation to at most `most_vertices` vertices (0: no limit).
/// Throws as `make_model` does.
kernels::TriangleMesh repaired(kernels::TriangleMesh mesh, std::int64_t most_vertices);

/// Returns the diagonal that a model of this name has in all heaps (heap.hpp): 1, or up to 30 %
/// more or less, so that the sizes of different objects fit together.
double size_in_heaps(const std::string& name);

/// Says which models are read.
struct ModelChoice {
  std::vector<std::filesystem::path> places;  ///< Files, and folders that are searched for scans.
  std::int64_t most_vertices = 5000;          ///< Largest number of vertices of a model.
  std::int64_t most_models = 0;               ///< Largest number of models; 0: all.
  bool as_in_heaps = false;                   ///< Models get the size that they have in heaps.
};

/// Names a file that is no model.
struct SkippedModel {
  std::filesystem::path path;
  std::string why;  ///< Reason in words.
};

/// Reads the closed meshes among the files, in the order of their paths within each place. A model
/// is named by the stem of its file; a stem that comes again gets a number. Files that are no
/// closed meshes are added to `skipped`.
BenchModels read_models(const ModelChoice& choice, std::vector<SkippedModel>& skipped);

}  // namespace semigeo::recognition
