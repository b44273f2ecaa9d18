#pragma once

#include <memory>
#include <string_view>

#include "io/files/image.hpp"
#include "jobs/picture/colour_scale.hpp"

namespace semigeo::jobs {

/// Draws text into pictures with the font that the program holds (DejaVu Sans). Characters that the
/// font does not have are drawn as boxes. Only one thread may use it at a time.
class Lettering {
 public:
  /// Text will have this size: the height of a line is about 1.2 times as many pixels.
  explicit Lettering(int size);
  ~Lettering();
  Lettering(const Lettering&) = delete;
  Lettering& operator=(const Lettering&) = delete;

  /// Returns the width of a text, UTF-8, in pixels.
  int width(std::string_view text) const;
  /// Draws a text, UTF-8. It begins at column `x`, and its letters stand on row `y`. What lies
  /// outside of the picture is left out.
  void draw(io::Image& image, int x, int y, std::string_view text, const Colour& colour) const;

 private:
  struct Font;
  std::unique_ptr<Font> font_;
};

}  // namespace semigeo::jobs
