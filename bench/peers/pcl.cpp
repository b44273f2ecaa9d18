// The only file that includes PCL.
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/ppf.h>
#include <pcl/features/principal_curvatures.h>
#include <pcl/pcl_config.h>
#include <pcl/search/kdtree.h>

#include "bench/peers/method.hpp"

namespace semigeo::peers {
namespace {

/// The number of nearest neighbours that each estimation uses.
constexpr int kNeighbours = 25;
/// The number of points whose pairs are described.
constexpr std::size_t kPairedPoints = 1000;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

/// Returns every n-th vertex of a subject, at most `most`; all if it is 0.
Cloud::Ptr cloud_of(const Subject& subject, std::size_t most = 0) {
  Cloud::Ptr cloud(new Cloud);
  const auto& points = subject.surface.points;
  const std::size_t step = most == 0 ? 1 : (points.size() + most - 1) / most;
  for (std::size_t v = 0; v < points.size(); v += step)
    cloud->push_back({points[v].x(), points[v].y(), points[v].z()});
  return cloud;
}

/// Returns the normals that belong to `cloud_of`.
Normals::Ptr given_normals(const Subject& subject, std::size_t most) {
  Normals::Ptr normals(new Normals);
  const std::size_t step = (subject.normals.size() + most - 1) / most;
  for (std::size_t v = 0; v < subject.normals.size(); v += step) {
    const Eigen::Vector3f n = subject.normals[v].cast<float>();
    normals->push_back({n.x(), n.y(), n.z()});
  }
  return normals;
}

Normals::Ptr estimated_normals(const Cloud::Ptr& cloud, const Tree::Ptr& tree) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree);
  estimation.setKSearch(kNeighbours);
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  return normals;
}

/// Estimates normals and then features of one kind at every vertex.
template <typename Estimation, typename Feature>
Result estimate(const Subject& subject) {
  const Cloud::Ptr cloud = cloud_of(subject);
  const double start = cpu_seconds();
  const Tree::Ptr tree(new Tree);
  Estimation estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(estimated_normals(cloud, tree));
  estimation.setSearchMethod(tree);
  estimation.setKSearch(kNeighbours);
  pcl::PointCloud<Feature> features;
  estimation.compute(features);
  return {cpu_seconds() - start, static_cast<double>(cloud->size()), {}, {}};
}

Result point_pairs(const Subject& subject) {
  const Cloud::Ptr cloud = cloud_of(subject, kPairedPoints);
  pcl::PPFEstimation<pcl::PointXYZ, pcl::Normal, pcl::PPFSignature> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(given_normals(subject, kPairedPoints));
  const double start = cpu_seconds();
  pcl::PointCloud<pcl::PPFSignature> features;
  estimation.compute(features);
  return {cpu_seconds() - start, static_cast<double>(features.size()), {}, {}};
}

}  // namespace

Library point_cloud_library() {
  using Curvatures =
      pcl::PrincipalCurvaturesEstimation<pcl::PointXYZ, pcl::Normal, pcl::PrincipalCurvatures>;
  using Histograms = pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33>;
  return {"PCL",
          "libpcl-dev",
          PCL_VERSION_PRETTY,
          {{"normals and principal curvatures", estimate<Curvatures, pcl::PrincipalCurvatures>},
           {"normals and FPFH", estimate<Histograms, pcl::FPFHSignature33>},
           {"point-pair features, each pair", point_pairs}}};
}

}  // namespace semigeo::peers
