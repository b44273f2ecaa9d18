#include "jobs/stages/recognised_file.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <span>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/small_file.hpp"
#include "io/files/utf8.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "semigeo-recognition";
constexpr int kFormatVersion = 1;
constexpr io::TextBounds kBounds = {.bytes = std::int64_t{64} << 20};
constexpr const char* kRemedy = "remove it, and recognise the scene again";

/// Source: thesis 4.6, (4.21): scale, translation (d, h, q), angles gamma, beta, alpha.
json pose_json(const kernels::Similarity& pose) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  const Eigen::Matrix4d m = pose.matrix();
  json rows = json::array();
  for (int i = 0; i < 4; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2), m(i, 3)});
  const kernels::EulerAngles angles = kernels::euler_angles(pose.rotation);
  return {{"matrix", rows},
          {"scale", pose.scale},
          {"d", pose.translation.x()},
          {"h", pose.translation.y()},
          {"q", pose.translation.z()},
          {"gamma_radians", angles.gamma},
          {"beta_radians", angles.beta},
          {"alpha_radians", angles.alpha},
          {"gamma_degrees", angles.gamma * kDegrees},
          {"beta_degrees", angles.beta * kDegrees},
          {"alpha_degrees", angles.alpha * kDegrees}};
}

/// Says how a candidate lies in what the scanner saw.
json view_json(const Candidate& candidate) {
  const kernels::View& view = *candidate.view;
  return {{"score", candidate.view_score},
          {"there", view.there},
          {"behind", view.behind},
          {"nothing", view.nothing},
          {"opposed", view.opposed}};
}

json candidates_json(std::span<const Candidate> candidates, const io::HashLibrary& library) {
  json list = json::array();
  for (const Candidate& candidate : candidates) {
    const io::ModelInfo& model = library.models()[static_cast<std::size_t>(candidate.model)];
    list.push_back({{"model", io::as_utf8(model.name)},
                    {"model_digest", model.digest},
                    {"score", candidate.score},
                    {"votes", candidate.votes},
                    {"cluster", candidate.cluster},
                    {"support", candidate.support},
                    {"match", candidate.match},
                    {"conflict", candidate.conflict},
                    {"closeness", candidate.closeness},
                    {"stability", candidate.stability},
                    {"explained", candidate.explained},
                    {"pose", pose_json(candidate.pose)}});
    if (candidate.view) list.back()["view"] = view_json(candidate);
  }
  return list;
}

/// Returns the models that resemble the scene most as a whole, and all of the ranking, the most
/// alike first.
json resemblance_json(const Recognition& recognition, std::size_t ranked,
                      const io::HashLibrary& library) {
  const std::vector<double>& whole = recognition.resemblance;
  std::vector<std::size_t> order(whole.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return whole[i]; });
  std::vector<std::uint8_t> is_ranked(whole.size());
  for (const Candidate& candidate : std::span(recognition.ranking).first(ranked))
    is_ranked[static_cast<std::size_t>(candidate.model)] = 1;
  json list = json::array();
  for (std::size_t place = 0; place < order.size(); ++place) {
    const std::size_t i = order[place];
    if (place >= kMostResembling && is_ranked[i] == 0) continue;
    const io::ModelInfo& model = library.models()[i];
    list.push_back(
        {{"model", io::as_utf8(model.name)}, {"model_digest", model.digest}, {"whole", whole[i]}});
  }
  return list;
}

json scene_json(const RecognisedScene& scene) {
  json document = {{"name", io::as_utf8(scene.name)},
                   {"input_name", scene.input_name},
                   {"xxh3", scene.xxh3},
                   {"format", scene.format},
                   {"vertices", scene.vertices},
                   {"triangles", scene.triangles},
                   {"features", scene.features},
                   {"samples", scene.samples},
                   {"turned", scene.turned}};
  if (scene.eye) document["eye"] = {scene.eye->x(), scene.eye->y(), scene.eye->z()};
  if (scene.repairs) document["repairs"] = json_of(*scene.repairs);
  return document;
}

std::string text_of(const json& document) {
  return document.dump(2) + '\n';
}

std::string digest_of(const json& document) {
  return io::xxh3_of_text(document.dump());
}

}  // namespace

void write_recognised(const std::filesystem::path& path, const std::string& key,
                      const RecognisedScene& scene, const io::HashLibrary& library,
                      const SearchParameters& parameters, const Recognition& recognition) {
  const std::size_t ranked = std::min(recognition.ranking.size(), kMostRanked);
  json document = {
      {"format", kFormat},
      {"format_version", kFormatVersion},
      {"job_key", key},
      {"scene", scene_json(scene)},
      {"library",
       {{"digest", library.digest()},
        {"models", library.models().size()},
        {"parameters", library.parameters()}}},
      {"search", json_of(parameters)},
      {"scene_triplets", recognition.scene_triplets},
      {"matches", recognition.matches},
      {"models_ranked", recognition.ranking.size()},
      {"objects", candidates_json(recognition.objects, library)},
      {"ranking", candidates_json(std::span(recognition.ranking).first(ranked), library)}};
  if (parameters.resemblance) {
    document["resemblance"] = resemblance_json(recognition, ranked, library);
    if (!scene.dataset_digest.empty()) document["scene"]["dataset_digest"] = scene.dataset_digest;
  }
  document["digest"] = digest_of(document);
  io::write_file_atomically(path, text_of(document));
}

json read_recognised(const std::filesystem::path& path) {
  const std::string text = io::read_text(path, kBounds);
  json document = io::parse_json(text, kBounds);
  if (!document.is_object() || document.value("format", json()) != kFormat)
    throw io::Error(path, "", "is not what semigeo has recognised, or is damaged", kRemedy);
  if (document.value("format_version", json()) != kFormatVersion)
    throw io::Error(path, "", "is of another version", kRemedy);
  json content = document;
  content.erase("digest");
  // A changed digit does not always change the number that is read, so bytes are compared.
  if (document.value("digest", json()) != digest_of(content) || text != text_of(document))
    throw io::Error(path, "", "is damaged: it does not have its digest", kRemedy);
  return document;
}

std::string recognised_key(const std::filesystem::path& path) {
  const json document = read_recognised(path);
  const auto key = document.find("job_key");
  return key != document.end() && key->is_string() ? key->get<std::string>() : "";
}

}  // namespace semigeo::jobs
