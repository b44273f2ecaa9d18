#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/peers/agreement.hpp"
#include "bench/peers/method.hpp"

namespace semigeo::peers {

/// Describes a range view in its own file.
struct RangeView {
  std::string name;                                        ///< Stem of the file.
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< Leads from the object to the view.
};
/// Returns the three views of the Stanford bunny that are used, with their published poses.
std::vector<RangeView> bunny_views();

/// Holds views of one object in its frame.
class ViewsOfOneObject {
 public:
  /// Reads `<name>.ply.gz` of each view from a folder and evolves it up to `last_level`. A vertex
  /// is trusted if it lies at least `inside` edges from a rim and its patch is complete on every
  /// level. Throws io::Error if a file cannot be read.
  ViewsOfOneObject(const std::filesystem::path& folder, const std::vector<RangeView>& views,
                   int last_level, int inside);

  /// Returns how well the levels of ours agree.
  std::vector<AgreementRow> levels() const;
  /// Returns how well jets agree that use all vertices within `radius` mean edge lengths. Call it
  /// only if CGAL is installed.
  AgreementRow jets(int degree, double radius) const;

  /// Returns the mean edge length of all views, in their unit.
  double mean_edge_length() const { return mean_edge_length_; }

 private:
  struct Evolved {
    std::vector<std::vector<double>> mean;  ///< (levels, N) H, NaN where a vertex is gone.
    std::vector<double> seconds;            ///< (levels) CPU time up to each level.
  };
  struct Pair {
    std::size_t first = 0, second = 0;
    std::vector<SamePlace> places;
  };
  Evolved evolve(std::size_t view, int last_level);
  Agreement agreement(const std::vector<std::vector<double>>& mean) const;

  std::vector<Subject> subjects_;
  std::vector<std::vector<std::uint8_t>> trusted_;  ///< For each view and vertex.
  std::vector<Evolved> evolved_;
  std::vector<Pair> pairs_;
  double mean_edge_length_ = 0;
};

}  // namespace semigeo::peers
