// The only file that includes OpenCV.
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/core/version.hpp>
#include <opencv2/surface_matching.hpp>
#include <vector>

#include "bench/peers/method.hpp"

namespace semigeo::peers {
namespace {

/// Distance of the points that the detector samples, as a share of the diameter, in models and in
/// scenes. The default is half of that; a model then takes minutes.
constexpr double kSampling = 0.1;

/// Returns the (N, 6) points and normals of a subject.
cv::Mat points_with_normals(const Subject& subject) {
  const auto& points = subject.surface.points;
  cv::Mat result(static_cast<int>(points.size()), 6, CV_32F);
  for (std::size_t v = 0; v < points.size(); ++v) {
    auto* const row = result.ptr<float>(static_cast<int>(v));
    for (int i = 0; i < 3; ++i) {
      row[i] = points[v][i];
      row[i + 3] = static_cast<float>(subject.normals[v][i]);
    }
  }
  return result;
}

/// Learns a model. If `match` is set, the model is then found in
/// itself, and that alone is timed.
Result point_pairs(const Subject& subject, bool match) {
  // On a sphere nearly all pairs look alike, and OpenCV 4.6.0 damages the heap when it matches
  // them.
  if (!subject.truth.empty()) return {};
  cv::setNumThreads(1);
  const cv::Mat model = points_with_normals(subject);
  double start = cpu_seconds();
  cv::ppf_match_3d::PPF3DDetector detector(kSampling);
  detector.trainModel(model);
  if (match) {
    start = cpu_seconds();
    std::vector<cv::ppf_match_3d::Pose3DPtr> poses;
    detector.match(model, poses, 1.0 / 5, kSampling);
  }
  return {cpu_seconds() - start, static_cast<double>(model.rows), {}, {}};
}

}  // namespace

Library opencv() {
  return {"OpenCV",
          "libopencv-contrib-dev",
          CV_VERSION,
          {{"point-pair features, a model learnt",
            [](const Subject& subject) { return point_pairs(subject, false); }},
           {"point-pair features, a scene matched",
            [](const Subject& subject) { return point_pairs(subject, true); }}}};
}

}  // namespace semigeo::peers
