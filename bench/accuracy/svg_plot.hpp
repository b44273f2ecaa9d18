#pragma once

#include <string>
#include <utility>
#include <vector>

namespace semigeo::accuracy {

/// One curve.
struct Series {
  std::string label;
  std::vector<std::pair<double, double>> points;  ///< what is not finite is left out
};

/// Curves over one pair of axes. The y axis starts at 0, or is logarithmic where the curves differ
/// by more than a factor of 20.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;  ///< in an order that their colours show
};

/// An SVG document of panels, `columns` a row, with one legend beside them: that of the first, with
/// `legend_title` above it.
std::string svg(const std::vector<Plot>& panels, int columns, const std::string& legend_title);

}  // namespace semigeo::accuracy
