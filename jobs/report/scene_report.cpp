#include "jobs/report/scene_report.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/base64.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/report/shown_surface.hpp"
#include "jobs/stages/recognised_file.hpp"
#include "jobs/stages/scan_surface.hpp"
#include "jobs/stages/search_parameters.hpp"
#include "kernels/surface/nearest_surface.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using nlohmann::json;

/// Bytes of the page for each vertex: points and two triangles, as base64.
constexpr double kBytesPerVertex = 30;
/// Bytes of the page for each vertex of the scene and each object.
constexpr double kBytesPerResidual = 3;
/// Points of the scene that are farther from a model than this number of mean edge lengths are not
/// the model's.
constexpr double kResidualEdges = 3;

/// A surface in the coordinates of its file.
struct PlacedSurface {
  ShownSurface surface;
  Vector3d origin = Vector3d::Zero();  ///< It is added to the points.
};

PlacedSurface surface_of(const io::Dataset& dataset) {
  const auto& origin = dataset.header().origin;
  return {.surface = read_shown_surface(dataset, 0), .origin = {origin[0], origin[1], origin[2]}};
}

PlacedSurface read_scene(const SceneFiles& files, const std::string& xxh3, double depth_jump) {
  constexpr const char* kRemedy = "recognise the scene again";
  const fs::path& path = files.scene;
  if (path.empty())
    throw io::Error(files.recognised, "", "its scene is not in sources.json beside it", kRemedy);
  if (io::is_scan_name(path)) {
    kernels::BuiltSurface built = read_surface(path, xxh3, depth_jump).built;
    return {.surface = {.points = std::move(built.surface.points),
                        .triangles = std::move(built.surface.triangles)},
            .origin = built.origin};
  }
  if (io::xxh3_of_file(path) != xxh3)
    throw io::Error(path, "", "has changed since it was recognised", kRemedy);
  return surface_of(io::Dataset(path));
}

PlacedSurface read_model(const fs::path& path, const std::string& digest) {
  if (!io::is_there(path))
    throw io::Error(path, "", "is not in this archive", "make the report of the library's archive");
  const io::Dataset dataset(path);
  if (dataset.digest() != digest)
    throw io::Error(path, "", "has changed since the scene was recognised",
                    "build the library and recognise the scene again");
  return surface_of(dataset);
}

json placed_json(const PlacedSurface& placed) {
  json object = {{"origin", {placed.origin.x(), placed.origin.y(), placed.origin.z()}}};
  add_surface(object, placed.surface, box_of(placed.surface.points));
  return object;
}

/// Returns the matrix of the pose of an object. Throws json::exception if it has none.
Eigen::Matrix4d matrix_of(const json& object) {
  Eigen::Matrix4d matrix;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = object.at("pose").at("matrix").at(i).at(j);
  return matrix;
}

/// The distances of the scene's shown vertices from the models in their poses.
class Residuals {
 public:
  /// `limit` is in the units of the scene.
  Residuals(const PlacedSurface& scene, double limit) : scene_(scene), limit_(limit) {}

  /// Returns the residual of an object. `surface` is its model.
  json of(const json& object, const kernels::NearestSurface& surface,
          const Vector3d& origin) const {
    const Eigen::Matrix4d to_model = matrix_of(object).inverse();
    const double scale = object.at("pose").at("scale");
    std::vector<std::uint16_t> shares;
    std::vector<double> near;
    for (const Eigen::Vector3f& point : scene_.surface.points) {
      const Vector3d p = point.cast<double>() + scene_.origin;
      const Vector3d q = (to_model * p.homogeneous()).head<3>() - origin;
      const double distance = scale * surface.nearest(q, limit_ / scale).distance;
      if (distance <= limit_) near.push_back(distance);
      shares.push_back(share_of(distance));
    }
    json residual = {{"distances", io::base64_of(shares)},
                     {"share", shares.empty() ? 0.0
                                              : static_cast<double>(near.size()) /
                                                    static_cast<double>(shares.size())}};
    if (!near.empty()) {
      const auto middle = near.begin() + std::ssize(near) / 2;
      std::ranges::nth_element(near, middle);
      residual["median"] = *middle;
    }
    return residual;
  }

 private:
  std::uint16_t share_of(double distance) const {
    constexpr std::uint16_t kBeyond = std::numeric_limits<std::uint16_t>::max();
    if (!(distance <= limit_)) return kBeyond;
    return static_cast<std::uint16_t>(std::lround((kBeyond - 1) * distance / limit_));
  }

  const PlacedSurface& scene_;
  double limit_;
};

class SceneReader {
 public:
  SceneReader(const SceneFiles& files, const ScenePageLimits& limits)
      : files_(files), limits_(limits), document_(read_recognised(files.recognised)) {}

  json read() {
    json& objects = document_.at("objects");
    for (const json& object : objects)
      digests_.emplace(object.at("model").get<std::string>(), object.at("model_digest"));
    read_scene_surface();
    document_["models"] = json::array();
    for (const auto& [name, digest] : digests_) add_model(name, digest);
    document_["title"] = document_.at("scene").at("input_name");
    add_titles();
    document_.erase("job_key");
    return std::move(document_);
  }

 private:
  void read_scene_surface() {
    const auto objects = static_cast<double>(document_.at("objects").size());
    try {
      scene_ = read_scene(files_, document_.at("scene").at("xxh3"),
                          search_parameters_from_json(document_.at("search")).depth_jump);
      const double edge = kernels::mean_edge_length(connected(scene_.surface));
      limit_ = kResidualEdges * edge;
      scene_.surface = decimated(std::move(scene_.surface),
                                 most_vertices(kBytesPerVertex + kBytesPerResidual * objects));
      document_["surface"] = placed_json(scene_);
      document_["residual"] = {{"limit", limit_}};
    } catch (const io::Error& e) {
      io::rethrow_if_unread(e);
      scene_ = {};
      document_["surface"] = {{"missing", e.what()}};
    }
  }

  /// Returns how many vertices of a surface are shown, if each takes so many bytes and the surface
  /// may have half of the page.
  std::int64_t most_vertices(double bytes) const {
    return std::min({kMostShownVertices, limits_.vertices,
                     static_cast<std::int64_t>(limits_.bytes / 2 / bytes)});
  }

  void add_model(const std::string& name, const std::string& digest) {
    json& models = document_["models"];
    const std::size_t place = models.size();
    for (json& object : document_.at("objects"))
      if (object.at("model") == name) object["shape"] = place;
    try {
      PlacedSurface model = read_model(dataset_of_model(files_.archive, name), digest);
      add_residuals(name, model);
      model.surface =
          decimated(std::move(model.surface),
                    most_vertices(kBytesPerVertex * static_cast<double>(digests_.size())));
      models.push_back(placed_json(model));
    } catch (const io::Error& e) {
      io::rethrow_if_unread(e);
      models.push_back({{"missing", e.what()}});
    }
    models.back()["name"] = name;
  }

  void add_titles() {
    json titles = json::object();
    for (const char* list : {"objects", "ranking"})
      for (const json& candidate : document_.at(list)) {
        const auto model = candidate.at("model").get<std::string>();
        if (titles.contains(model)) continue;
        try {
          titles[model] = io::Dataset(dataset_of_model(files_.archive, model)).header().input_name;
        } catch (const io::Error& e) {
          io::rethrow_if_unread(e);
          titles[model] = model;
        }
      }
    document_["titles"] = std::move(titles);
  }

  void add_residuals(const std::string& name, const PlacedSurface& model) {
    if (scene_.surface.points.empty()) return;
    const kernels::Surface surface = connected(model.surface);
    const kernels::NearestSurface nearest(surface);
    const Residuals residuals(scene_, limit_);
    for (json& object : document_.at("objects"))
      if (object.at("model") == name)
        object["residual"] = residuals.of(object, nearest, model.origin);
  }

  const SceneFiles& files_;
  const ScenePageLimits& limits_;
  json document_;
  std::map<std::string, std::string> digests_;  ///< Digest of each model that was found.
  PlacedSurface scene_;
  double limit_ = 0;
};

}  // namespace

fs::path dataset_of_model(const fs::path& archive, const std::string& model) {
  return dataset_path(archive, fs::path(model).filename().string());
}

json scene_report(const SceneFiles& files, const ScenePageLimits& limits) {
  try {
    return SceneReader(files, limits).read();
  } catch (const json::exception& e) {
    throw io::Error(files.recognised, "", "lacks a field: " + std::string(e.what()),
                    "remove it, and recognise the scene again");
  }
}

}  // namespace semigeo::jobs
