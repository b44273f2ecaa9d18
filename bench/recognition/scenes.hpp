#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/recognition/bench_model.hpp"
#include "bench/support/chance.hpp"
#include "kernels/recognition/similarity.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::recognition {

/// What is done to the objects of a scene, in this order, before they are put together and the
/// whole is rotated, scaled and moved.
struct SceneKind {
  const char* name;
  const char* says;
  int objects = 1;           ///< different ones
  int copies = 1;            ///< of each, at most; from two on, two or so many
  double vertices_left = 1;  ///< share that quadric decimation leaves
  double removed = 0;        ///< share of the vertices, a ball
  double noise = 0;          ///< sigma a coordinate, in mean edge lengths of what is there then
};
/// A to F, H and the hard ones.
std::span<const SceneKind> scene_kinds();
/// Nothing if there is no such kind.
const SceneKind* scene_kind(const std::string& name);

/// An object of a scene, and where it is.
struct PlacedObject {
  std::size_t model = 0;
  kernels::Similarity pose;  ///< model to scene, in coordinates of the files
};

struct Scene {
  std::string kind;
  std::string name;  ///< of its first object
  std::uint64_t seed = 0;
  kernels::TriangleMesh mesh;
  std::vector<PlacedObject> objects;
};

/// One scene: the object `first` and, where the kind wants more, others that the seed picks, one
/// touching the next. All chance comes from kind, seed and the name of the object. Throws
/// std::runtime_error if OpenMesh cannot hold a model, or there are fewer models than objects.
Scene make_scene(const SceneKind& kind, ModelSpan models, std::size_t first, std::uint64_t seed);

/// The mesh after what the kind does to an object.
kernels::TriangleMesh changed(const SceneKind& kind, const kernels::TriangleMesh& mesh,
                              const bench::Random& random);

/// The table of the thesis: scale and degrees about x, y and z of its twelve scenes. Source: 6.1.
struct ThesisPlacement {
  const char* object;
  double scale;
  double x, y, z;
};
std::span<const ThesisPlacement> thesis_placements();
/// R = Rz Ry Rx. Source: 4.6.
kernels::Similarity similarity_of(const ThesisPlacement& placement);

}  // namespace semigeo::recognition
