#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/surface/surface.hpp"

namespace semigeo::peers {

/// Describes one scan of an object.
struct View {
  kernels::Surface surface;           ///< Its points are in the frame of the object.
  std::vector<std::uint8_t> trusted;  ///< (N) 1 = the curvature of the vertex may be compared.
};

/// Says that a vertex of one view and a point on a face of another one are the same place.
struct SamePlace {
  std::int32_t vertex = 0;                ///< Vertex of the first view.
  std::array<std::int32_t, 3> corners{};  ///< Corners of the face of the second view.
  Eigen::Vector3d weights{0, 0, 0};       ///< Weights of the corners; their sum is 1.
};

/// Returns the trusted vertices of `first` for which the nearest point of `second` is no farther
/// than `distance`, lies on a face of three trusted corners, and faces the same way.
std::vector<SamePlace> same_places(const View& first, const View& second, double distance);

/// Compares the values of two views at the same places.
struct Agreement {
  std::int64_t places = 0;
  double median_difference = 0;  ///< Median |difference|, as a share of the median |value|.
  double rms_difference = 0;     ///< RMS difference, as a share of the RMS value.
  double rms = 0;                ///< RMS value, of both views.
};

/// Collects values at the same places, of any number of pairs of views.
class Comparison {
 public:
  /// Adds the values of a pair of views: `first` (N) and `second` (M) at their vertices. Places
  /// where a value is not finite are left out.
  void add(std::span<const SamePlace> places, std::span<const double> first,
           std::span<const double> second);
  /// Returns how well all that was added agrees.
  Agreement agreement() const;

 private:
  std::vector<double> differences_;  ///< |first - second|
  std::vector<double> values_;       ///< |first| and |second|
};

/// Says how well views of one object agree in H, by one method.
struct AgreementRow {
  std::string method;
  double size = 0;          ///< Level of ours; radius of jets, in mean edge lengths.
  double microseconds = 0;  ///< CPU time for a vertex; for level k, that of levels 0 to k.
  Agreement agreement;
};

/// Returns what a method would do at the size that leaves the RMS `rms` of H. It lies between two
/// of the rows, which must fall in RMS, and is interpolated on logarithmic scales. All numbers are
/// NaN if no two rows enclose that RMS.
AgreementRow at_equal_detail(std::span<const AgreementRow> rows, double rms);

}  // namespace semigeo::peers
