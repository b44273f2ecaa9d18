#include "bench/peers/scan_views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bench/peers/jets.hpp"
#include "bench/peers/neighbourhoods.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/stages/evolving_surface.hpp"

namespace semigeo::peers {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Reads a view and moves it into the frame of the object.
Subject read_view(const std::filesystem::path& folder, const RangeView& view) {
  kernels::TriangleMesh mesh = io::read_scan(folder / (view.name + ".ply.gz")).mesh;
  const Eigen::Isometry3d to_object = view.pose.inverse();
  for (Eigen::Vector3d& p : mesh.points) p = to_object * p;
  return make_subject(view.name, std::move(mesh));
}

double microseconds_each(double seconds, std::int64_t count) {
  return 1e6 * seconds / static_cast<double>(count);
}

}  // namespace

std::vector<RangeView> bunny_views() {
  Eigen::Isometry3d bun090, top3;
  bun090.matrix() << -0.0031016172, -0.0013264384, -0.99999431, -7.2063602e-05,  //
      0.00037492871, 0.99999905, -0.0013276077, 3.3356586e-05,                   //
      0.99999512, -0.00037904431, -0.0031011169, -2.2312229e-05,                 //
      0, 0, 0, 1;
  top3.matrix() << -0.8260842, 0.47347167, -0.30562961, -0.074915556,  //
      -0.31284839, 0.065793841, 0.94752154, 0.0629925,                 //
      0.46873316, 0.87834831, 0.093773599, -0.03081104,                //
      0, 0, 0, 1;
  return {{"bun000", Eigen::Isometry3d::Identity()}, {"bun090", bun090}, {"top3", top3}};
}

ViewsOfOneObject::ViewsOfOneObject(const std::filesystem::path& folder,
                                   const std::vector<RangeView>& views, int last_level,
                                   int inside) {
  for (const RangeView& view : views) {
    subjects_.push_back(read_view(folder, view));
    const kernels::Surface& surface = subjects_.back().surface;
    mean_edge_length_ += kernels::mean_edge_length(surface) / static_cast<double>(views.size());
    std::vector<std::uint8_t>& trusted = trusted_.emplace_back();
    for (const int edges : edges_to_boundary(surface, inside)) trusted.push_back(edges == inside);
    evolved_.push_back(evolve(subjects_.size() - 1, last_level));
  }
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = 0; j < views.size(); ++j)
      if (i != j)
        pairs_.push_back({i, j,
                          same_places({subjects_[i].surface, trusted_[i]},
                                      {subjects_[j].surface, trusted_[j]}, mean_edge_length_ / 2)});
}

/// Computes the levels of a view, and withdraws trust where a patch is not complete.
ViewsOfOneObject::Evolved ViewsOfOneObject::evolve(std::size_t view, int last_level) {
  engine::Workers worker(1);
  engine::Observer observer;
  std::vector<std::uint8_t>& trusted = trusted_[view];
  Evolved result;
  kernels::Surface surface = subjects_[view].surface;
  double seconds = -cpu_seconds();
  jobs::EvolvingSurface evolving(std::move(surface), {}, {worker, observer, {}});
  for (int k = 0; k <= last_level; ++k) {
    if (k > 0) evolving.move();
    const jobs::LevelFields fields = evolving.evaluate();
    result.seconds.push_back(seconds + cpu_seconds());
    const double pause = cpu_seconds();
    std::vector<double>& mean = result.mean.emplace_back(trusted.size(), kNothing);
    for (std::size_t v = 0; v < fields.points.size(); ++v) {
      const std::int32_t source = evolving.mesh().source[v];
      if (source >= 0 && fields.patch_completeness[v] == 1) mean[source] = fields.mean_curvature[v];
    }
    for (std::size_t v = 0; v < trusted.size(); ++v)
      if (std::isnan(mean[v])) trusted[v] = 0;
    seconds -= cpu_seconds() - pause;
  }
  return result;
}

Agreement ViewsOfOneObject::agreement(const std::vector<std::vector<double>>& mean) const {
  Comparison comparison;
  for (const Pair& pair : pairs_) comparison.add(pair.places, mean[pair.first], mean[pair.second]);
  return comparison.agreement();
}

std::vector<AgreementRow> ViewsOfOneObject::levels() const {
  std::vector<AgreementRow> rows;
  for (std::size_t k = 0; k < evolved_[0].mean.size(); ++k) {
    AgreementRow& row = rows.emplace_back();
    row.method = "semigeo";
    row.size = static_cast<double>(k);
    std::vector<std::vector<double>> mean;
    double seconds = 0;
    std::int64_t vertices = 0;
    for (std::size_t i = 0; i < subjects_.size(); ++i) {
      mean.push_back(evolved_[i].mean[k]);
      seconds += evolved_[i].seconds[k];
      vertices += subjects_[i].surface.vertex_count();
    }
    row.microseconds = microseconds_each(seconds, vertices);
    row.agreement = agreement(mean);
  }
  return rows;
}

#ifdef SEMIGEO_PEERS_CGAL
AgreementRow ViewsOfOneObject::jets(int degree, double radius) const {
  AgreementRow row{"jets of degree " + std::to_string(degree), radius, 0, {}};
  std::vector<std::vector<double>> mean;
  double seconds = 0;
  std::int64_t fits = 0;
  for (std::size_t i = 0; i < subjects_.size(); ++i) {
    Result result = fit_jets(subjects_[i], {degree, radius * mean_edge_length_}, trusted_[i]);
    seconds += result.seconds;
    fits += std::ranges::count(trusted_[i], 1);
    mean.push_back(std::move(result.mean));
  }
  row.microseconds = microseconds_each(seconds, fits);
  row.agreement = agreement(mean);
  return row;
}
#endif

}  // namespace semigeo::peers
