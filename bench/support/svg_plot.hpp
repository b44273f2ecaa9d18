#pragma once

#include <string>
#include <utility>
#include <vector>

namespace semigeo::bench {

/// One curve.
struct Series {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< what is not finite is left out
};

/// Curves over one pair of axes.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;  ///< in an order that their colours show
};

/// An SVG document of panels, `columns` a row, with one legend beside them: that of the first, with
/// `legend_title` above it. The y axes start at 0; where values of one panel differ by more than a
/// factor of 20, those of all panels are logarithmic.
std::string svg(const std::vector<Plot>& panels, int columns, const std::string& legend_title);

}  // namespace semigeo::bench
