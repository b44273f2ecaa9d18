#pragma once

#include <string>
#include <utility>
#include <vector>

namespace semigeo::bench {

/// Describes one curve.
struct Series {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< Points that are not finite are left out.
};

/// Describes curves over one pair of axes.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;  ///< Colours show their order.
};

/// Returns an SVG document of panels, `columns` in a row. One legend, that of the first panel,
/// stands beside them under `legend_title`. The y axes start at 0. If the values of one panel
/// differ by more than a factor of 20, the y axes of all panels are logarithmic.
std::string svg(const std::vector<Plot>& panels, int columns, const std::string& legend_title);

}  // namespace semigeo::bench
