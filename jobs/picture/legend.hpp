#pragma once

#include <string>
#include <vector>

#include "io/files/image.hpp"
#include "jobs/picture/colour_scale.hpp"
#include "jobs/picture/lettering.hpp"

namespace semigeo::jobs {

/// A colour of lines, marks or areas, and what it means.
struct LegendKey {
  enum class Shape { kLine, kMark, kArea };
  std::string text;
  Colour colour = {};
  Shape shape = Shape::kMark;
};

/// What stands beside the panels of a picture.
struct Legend {
  int size = 1200;  ///< Pixels of the picture's height. Letters are a part of it.
  ColourScale scale = ColourScale::kSafe;
  std::string title;  ///< The field and its unit, "H in 1/mm"; empty: no colour bar.
  double limit = 0;   ///< The value at the upper end of the colour bar.
  std::string upper;  ///< What values at the upper end are, "concave".
  std::string lower;  ///< What values at the lower end are.
  std::vector<LegendKey> keys;
};

/// Returns a number for a legend: three significant digits, with a true minus sign.
std::string legend_number(double value);

/// Draws a legend, and captions below the panels.
class LegendPainter {
 public:
  explicit LegendPainter(Legend legend);

  /// Returns the width of the legend in pixels; 0 if it has nothing to say.
  int width() const { return width_; }
  /// Returns the height of captions in pixels.
  int caption_height() const { return 2 * letters_; }
  /// Draws the legend from column `x` on.
  void draw(io::Image& image, int x) const;
  /// Draws a text into the middle of the lowest lines of a panel that begins at column `x`.
  void draw_caption(io::Image& image, int x, int panel_width, const std::string& text) const;

 private:
  struct Label {
    double value;  ///< Between -1 and 1.
    std::string text;
  };
  std::vector<Label> labels() const;
  int draw_bar(io::Image& image, int x, int y) const;
  void draw_key(io::Image& image, int x, int y, const LegendKey& key) const;

  Legend legend_;
  int letters_;
  Lettering lettering_;
  int width_ = 0;
};

}  // namespace semigeo::jobs
