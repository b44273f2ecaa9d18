#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/draco_mesh.hpp"
#include "io/scans/gltf_file.hpp"
#include "io/scans/scan_builder.hpp"
#include "io/scans/scan_formats.hpp"
#include "io/scans/triangle_strip.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kExportAgain = "export the scan again";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// The numbers of a primitive's mode.
enum Mode : std::int64_t {
  kPoints = 0,
  kLines = 1,
  kLineLoop = 2,
  kLineStrip = 3,
  kTriangles = 4,
  kTriangleStrip = 5,
  kTriangleFan = 6
};

/// A node that is to be read, in the coordinates of the scene.
struct Visit {
  std::int64_t node = 0;
  Eigen::Affine3d to_scene = Eigen::Affine3d::Identity();
};

/// Returns the transformation from a node's coordinates to those of its parent.
Eigen::Affine3d transform_of(const GltfObject& node) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (const auto matrix = node.numbers<16>("matrix")) {
    transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->data());  // column after column
    if (transform.matrix().row(3) != Eigen::RowVector4d(0, 0, 0, 1))
      node.fail("its matrix is not an affine transformation", kExportAgain);
    return transform;
  }
  if (const auto t = node.numbers<3>("translation"))
    transform.translate(Eigen::Vector3d(t->data()));
  if (const auto r = node.numbers<4>("rotation")) {
    const Eigen::Quaterniond rotation((*r)[3], (*r)[0], (*r)[1], (*r)[2]);
    if (!(rotation.norm() > 0)) node.fail("its rotation is not a unit quaternion", kExportAgain);
    transform.rotate(rotation.normalized());
  }
  if (const auto s = node.numbers<3>("scale")) transform.scale(Eigen::Vector3d(s->data()));
  return transform;
}

/// Reads the surface of a scene into a builder.
class GltfScene {
 public:
  GltfScene(GltfFile& file, ScanBuilder& builder)
      : file_(file), root_(file.root()), builder_(builder) {}

  void read() {
    if (root_.size("nodes") == 0) {  // a file of meshes only
      for (std::int64_t i = 0; i < root_.size("meshes"); ++i) read_mesh(i, Visit{});
      return;
    }
    visited_.resize(static_cast<std::size_t>(root_.size("nodes")));
    for (const std::int64_t node : top_nodes()) read_tree(node);
  }

 private:
  /// Returns the nodes of the default scene, or of all scenes if there is none, or all that are no
  /// other's child if there are no scenes. Each is returned once.
  std::vector<std::int64_t> top_nodes() const {
    std::vector<std::int64_t> nodes;
    std::vector<bool> passed_over(visited_.size(), false);
    const auto add = [&](std::int64_t node) {
      const bool known = node < std::ssize(passed_over);  // if it is not, reading it says so
      if (known && passed_over[node]) return;
      if (known) passed_over[node] = true;
      nodes.push_back(node);
    };
    const std::int64_t scenes = root_.size("scenes");
    const std::int64_t only = root_.integer("scene", scenes);
    for (std::int64_t i = only < scenes ? only : 0; i < (only < scenes ? only + 1 : scenes); ++i) {
      const GltfObject scene = root_.item("scenes", i);
      for (std::int64_t k = 0; k < scene.size("nodes"); ++k) add(scene.index("nodes", k));
    }
    if (scenes > 0) return nodes;
    for (std::int64_t i = 0; i < root_.size("nodes"); ++i) {
      const GltfObject node = root_.item("nodes", i);
      for (std::int64_t k = 0; k < node.size("children"); ++k)
        if (const auto child = node.index("children", k); child < std::ssize(passed_over))
          passed_over[child] = true;
    }
    for (std::int64_t i = 0; i < root_.size("nodes"); ++i) add(i);
    if (nodes.empty()) root_.fail("its nodes form a cycle", kExportAgain);
    return nodes;
  }

  /// Reads a node and all below it. The tree may have any depth.
  void read_tree(std::int64_t top) {
    std::vector<Visit> waiting = {{.node = top}};
    while (!waiting.empty()) {
      Visit visit = waiting.back();
      waiting.pop_back();
      const GltfObject node = root_.item("nodes", visit.node);
      if (visited_[visit.node])
        node.fail("it is reached twice, so the nodes do not form a tree", kExportAgain);
      visited_[visit.node] = true;
      visit.to_scene = visit.to_scene * transform_of(node);
      if (node.has("mesh")) read_mesh(node.integer("mesh"), visit);
      for (std::int64_t k = node.size("children"); k-- > 0;)
        waiting.push_back({.node = node.index("children", k), .to_scene = visit.to_scene});
    }
  }

  void read_mesh(std::int64_t index, const Visit& visit) {
    const GltfObject mesh = root_.item("meshes", index);
    mirrored_ = visit.to_scene.linear().determinant() < 0;
    first_points_.clear();
    for (std::int64_t i = 0; i < mesh.size("primitives"); ++i)
      read_primitive(mesh.item("primitives", i), visit.to_scene);
  }

  void read_primitive(const GltfObject& primitive, const Eigen::Affine3d& to_scene) {
    const GltfObject attributes = primitive.object("attributes");
    if (!attributes.has("POSITION")) return;  // the format allows it, and nothing can be shown
    const std::int64_t accessor = attributes.integer("POSITION");
    if (is_packed(primitive, accessor)) return read_packed(primitive, to_scene);
    const Points points = add_points(accessor, to_scene, attributes);
    Corners corners{.first = points.first, .count = points.count};
    if (primitive.has("indices")) {
      const std::int64_t accessor_of_indices = primitive.integer("indices");
      corners.indices = file_.indices(accessor_of_indices);
      corners.count = std::ssize(corners.indices);
      corners.restart = restart_of(primitive, accessor_of_indices, points);
      for (const std::uint32_t index : corners.indices)
        if (index >= points.count && index != corners.restart)
          primitive.fail("a face refers to vertex " + std::to_string(index) + " of " +
                             std::to_string(points.count),
                         kExportAgain);
    }
    add_faces(primitive, corners);
  }

  /// Vertices of the scan that came from one accessor.
  struct Points {
    std::int64_t first = 0, count = 0;
  };
  /// The corners of a primitive, in its order.
  struct Corners {
    std::int64_t first = 0, count = 0;
    std::vector<std::uint32_t> indices = {};  // none: the vertices one after the other
    std::int64_t restart = -1;  // the index with which a new strip or fan begins, if there is one
    std::int64_t operator[](std::int64_t i) const {
      return first + (indices.empty() ? i : indices[static_cast<std::size_t>(i)]);
    }
    /// Returns whether a new strip or fan begins here.
    bool restarts(std::int64_t i) const {
      return !indices.empty() && indices[static_cast<std::size_t>(i)] == restart;
    }
  };

  /// Returns whether a primitive is compressed by Draco and not there in another form.
  bool is_packed(const GltfObject& primitive, std::int64_t accessor) const {
    return primitive.has("extensions") && primitive.object("extensions").has(kDraco) &&
           !file_.has_elements(accessor);
  }

  /// Reads a primitive that is compressed by Draco. It has triangles, whatever its mode.
  void read_packed(const GltfObject& primitive, const Eigen::Affine3d& to_scene) {
    const GltfObject packed = primitive.object("extensions").object(kDraco);
    const GltfObject ids = packed.object("attributes");
    std::optional<std::int64_t> normal_id;
    if (ids.has("NORMAL")) normal_id = ids.integer("NORMAL");
    Corners corners;
    try {
      DracoMesh mesh = decode_draco(file_.view_bytes(packed.integer("bufferView")).bytes,
                                    ids.integer("POSITION"), normal_id);
      corners.count = std::ssize(mesh.indices);
      corners.indices = std::move(mesh.indices);
      const Points points = append_points(mesh.positions, to_scene);
      corners.first = points.first;
      append_normals(mesh.normals, points, to_scene.linear());
    } catch (const Error&) {
      throw;
    } catch (const std::runtime_error& error) {
      packed.fail(std::string("its Draco data is damaged: ") + error.what(), kExportAgain);
    }
    add_triangles(corners);
  }

  /// Returns the index with which a new strip or fan begins, or -1. glTF has no such index, but
  /// writers use what graphics cards take for it: the largest number of the type.
  std::int64_t restart_of(const GltfObject& primitive, std::int64_t indices,
                          const Points& points) const {
    const std::int64_t mode = primitive.integer("mode", kTriangles);
    if (mode != kTriangleStrip && mode != kTriangleFan) return -1;
    const std::uint32_t largest = file_.largest_index(indices);
    return largest < points.count ? -1 : std::int64_t{largest};
  }

  /// Adds the vertices of an accessor, and their normals. Primitives of a mesh that share them get
  /// the same ones.
  Points add_points(std::int64_t accessor, const Eigen::Affine3d& to_scene,
                    const GltfObject& attributes) {
    const auto known = first_points_.find(accessor);
    if (known != first_points_.end()) return known->second;
    const Points points = append_points(file_.positions(accessor), to_scene);
    if (attributes.has("NORMAL")) add_normals(attributes, points, to_scene.linear());
    return first_points_[accessor] = points;
  }

  Points append_points(const std::vector<double>& xyz, const Eigen::Affine3d& to_scene) {
    const Points points{builder_.point_count(), std::ssize(xyz) / 3};
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
      const Eigen::Vector3d p = to_scene * Eigen::Vector3d(&xyz[i]);
      builder_.add_point(p.x(), p.y(), p.z(), {Place::Unit::kVertex, builder_.point_count()});
    }
    return points;
  }

  void append_normals(const std::vector<double>& normals, const Points& points,
                      const Eigen::Matrix3d& to_scene) {
    if (to_scene.determinant() == 0) return;
    const Eigen::Matrix3d turn = to_scene.inverse().transpose();
    for (std::int64_t i = 0; i < std::min(points.count, std::ssize(normals) / 3); ++i) {
      const Eigen::Vector3d normal = turn * Eigen::Vector3d(&normals[3 * i]);
      builder_.add_normal(points.first + i, normal.normalized().cast<float>());
    }
  }

  /// Adds the normals of vertices that were just added. Normals only help: damaged ones count as
  /// none.
  void add_normals(const GltfObject& attributes, const Points& points,
                   const Eigen::Matrix3d& to_scene) try {
    append_normals(file_.positions(attributes.integer("NORMAL")), points, to_scene);
  } catch (const ReadError&) {
    throw;
  } catch (const Error&) {
  }

  void add_faces(const GltfObject& primitive, const Corners& corners) {
    const std::int64_t mode = primitive.integer("mode", kTriangles), count = corners.count;
    if (mode > kTriangleFan)
      primitive.fail("its mode " + std::to_string(mode) + " is unknown", kExportAgain);
    std::int64_t i = 0;
    switch (static_cast<Mode>(mode)) {
      case kTriangles:
        add_triangles(corners);
        break;
      case kTriangleStrip:
        add_strips(corners);
        break;
      case kTriangleFan:
        add_fans(corners);
        break;
      case kPoints:
        for (; i < count; ++i) add_part(corners[i]);
        break;
      case kLines:
        for (; i + 1 < count; i += 2) add_part(corners[i]);
        break;
      case kLineLoop:
      case kLineStrip:
        for (; i + (mode == kLineStrip ? 1 : 0) < count; ++i) add_part(corners[i]);
        break;
    }
  }

  void add_triangles(const Corners& corners) {
    std::int64_t i = 0;
    for (; i + 2 < corners.count; i += 3) add(corners[i], corners[i + 1], corners[i + 2]);
    if (i < corners.count) add_part(corners[i]);  // corners that make no triangle
  }

  void add_strips(const Corners& corners) {
    TriangleStrip strip;
    for (std::int64_t i = 0; i < corners.count; ++i) {
      if (corners.restarts(i)) {
        strip.restart();
      } else if (const auto triangle = strip.next(corners[i])) {
        add((*triangle)[0], (*triangle)[1], (*triangle)[2]);
      }
    }
  }

  void add_fans(const Corners& corners) {
    std::int64_t first = 0;
    for (std::int64_t i = 0; i < corners.count; ++i) {
      if (corners.restarts(i)) first = i + 1;
      if (i - first >= 2) add(corners[i - 1], corners[i], corners[first]);
    }
  }

  Place face_place() { return {Place::Unit::kFace, faces_++}; }
  void add(std::int64_t a, std::int64_t b, std::int64_t c) {
    if (mirrored_) std::swap(b, c);
    builder_.add_face(std::array{a, b, c}, face_place());
  }
  /// Counts a point or a line, which is no face.
  void add_part(std::int64_t corner) { builder_.add_face(std::array{corner}, face_place()); }

  GltfFile& file_;
  GltfObject root_;
  ScanBuilder& builder_;
  std::vector<bool> visited_;
  std::map<std::int64_t, Points> first_points_;  // of the mesh that is being read, by accessor
  bool mirrored_ = false;
  std::int64_t faces_ = 0;
};

Scan read_gltf(ByteSource& source, const ScanOptions& options) {
  GltfFile file(source);
  ScanBuilder builder(source, options);
  GltfScene(file, builder).read();
  return builder.finish(file.is_binary() ? "glTF binary" : "glTF");
}

std::string variant_of(std::string_view begin) {
  return begin.starts_with("glTF") ? "glTF binary" : "glTF";
}

}  // namespace

const ScanFormat kGltfFormat = {
    .extension = ".gltf",
    .read = read_gltf,
    .variant = variant_of,
    .content = "meshes",
    .variants = "glTF 2.0, with its bytes in the file or in files beside it",
    .companions = gltf_references};
const ScanFormat kGlbFormat = {.extension = ".glb",
                               .read = read_gltf,
                               .variant = variant_of,
                               .content = "meshes",
                               .variants = "binary glTF 2.0",
                               .companions = gltf_references};

}  // namespace semigeo::io
