// The only file that includes CGAL.
#include <CGAL/Monge_via_jet_fitting.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>

#include <limits>

#include "bench/peers/jets.hpp"
#include "bench/peers/method.hpp"
#include "bench/peers/neighbourhoods.hpp"

namespace semigeo::peers {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;

Method jets(int degree) {
  return {"jets of degree " + std::to_string(degree), [degree](const Subject& subject) {
            return fit_jets(subject, {degree, 0});
          }};
}

}  // namespace

Result fit_jets(const Subject& subject, const JetOptions& options,
                std::span<const std::uint8_t> wanted) {
  const auto& points = subject.surface.points;
  const auto least = static_cast<std::size_t>((options.degree + 1) * (options.degree + 2) / 2);
  const double start = cpu_seconds();
  Result result;
  result.gaussian.assign(points.size(), std::numeric_limits<double>::quiet_NaN());
  result.mean = result.gaussian;
  Neighbourhoods neighbourhoods(subject.surface);
  std::vector<Kernel::Point_3> near;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!wanted.empty() && wanted[v] == 0) continue;
    const auto vertex = static_cast<std::int32_t>(v);
    const auto found = options.radius > 0 ? neighbourhoods.ball(vertex, options.radius, least)
                                          : neighbourhoods.rings(vertex, least);
    if (found.size() < least) continue;
    near.clear();
    for (const std::int32_t w : found)
      near.emplace_back(points[w].x(), points[w].y(), points[w].z());
    CGAL::Monge_via_jet_fitting<Kernel> fitting;
    auto monge = fitting(near.begin(), near.end(), options.degree, 2);
    const Eigen::Vector3d& n = subject.normals[v];
    monge.comply_wrt_given_normal({n.x(), n.y(), n.z()});
    const double k1 = monge.principal_curvatures(0), k2 = monge.principal_curvatures(1);
    result.gaussian[v] = k1 * k2;
    result.mean[v] = (k1 + k2) / 2;
  }
  result.items = static_cast<double>(points.size());
  result.seconds = cpu_seconds() - start;
  return result;
}

Library cgal() {
  return {"CGAL", "libcgal-dev", CGAL_VERSION_STR, {jets(2), jets(4)}};
}

}  // namespace semigeo::peers
