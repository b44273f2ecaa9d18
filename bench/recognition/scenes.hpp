#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/support/chance.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

/// Says what is done to the objects of a scene. The changes are made in the order of the fields.
/// Then the objects are put together, and the whole is rotated, scaled and moved.
struct SceneKind {
  const char* name;
  const char* says;          ///< Description of the kind, for tables.
  int objects = 1;           ///< Number of different objects.
  int copies = 1;            ///< Most copies of an object: 2 to so many, or just one.
  double vertices_left = 1;  ///< Share of the vertices that quadric decimation leaves.
  double removed = 0;        ///< Share of the vertices that are removed, in a ball.
  double noise = 0;  ///< Sigma of the noise in each coordinate, in mean edge lengths at that time.
};
/// Returns the kinds A to F, H and the hard ones.
std::span<const SceneKind> scene_kinds();
/// Returns the kind of this name, or null.
const SceneKind* scene_kind(const std::string& name);

/// Describes an object of a scene.
struct PlacedObject {
  std::size_t model = 0;     ///< Index of the model.
  kernels::Similarity pose;  ///< Leads from the model to the scene, in coordinates of the files.
  double occlusion = 0;      ///< Share of the object's surface that a scanner does not see.
  double clutter = 0;        ///< Share of what a scanner sees that is not this object.
};

/// Holds a scene whose objects are known.
struct Scene {
  std::string kind;        ///< Name of its kind.
  std::string name;        ///< Name of its first object.
  std::uint64_t seed = 0;  ///< Seed of all its random choices.
  kernels::TriangleMesh mesh;
  std::vector<PlacedObject> objects;
  double noise = 0;           ///< Noise of the scanner, in pixels.
  bool mixed_pixels = false;  ///< Pixels beside depth jumps lie between two surfaces.
};

/// Makes a scene of the model `first` (an index) and of others that are chosen at random, if the
/// kind has more objects. Each object touches the one before. The same kind, seed and name of the
/// object give the same scene. Throws std::runtime_error if OpenMesh cannot hold a model, or if
/// there are fewer models than objects.
Scene make_scene(const SceneKind& kind, ModelSpan models, std::size_t first, std::uint64_t seed);

/// Returns the mesh of an object after the changes of the kind.
kernels::TriangleMesh changed(const SceneKind& kind, const kernels::TriangleMesh& mesh,
                              const bench::Random& random);

/// Says how an object was placed in a scene of the thesis.
struct ThesisPlacement {
  const char* object;
  double scale;
  double x, y, z;  ///< Angles about the axes, in degrees.
};
/// Returns the placements of the twelve scenes. Source: thesis, table 6.1.
std::span<const ThesisPlacement> thesis_placements();
/// Returns the transform of a placement, with the rotation R = Rz Ry Rx. Source: thesis 4.6.
kernels::Similarity similarity_of(const ThesisPlacement& placement);

}  // namespace semigeo::recognition
