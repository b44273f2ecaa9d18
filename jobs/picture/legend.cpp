#include "jobs/picture/legend.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "io/files/number_text.hpp"

namespace semigeo::jobs {
namespace {

constexpr Colour kInk = {0.1f, 0.1f, 0.1f};
constexpr int kSmallestLetters = 11;

/// Fills a rectangle, as far as it lies in the picture.
void fill(io::Image& image, int x, int y, int width, int height, const Colour& colour) {
  for (int row = std::max(0, y); row < std::min(image.height, y + height); ++row)
    for (int column = std::max(0, x); column < std::min(image.width, x + width); ++column) {
      std::uint8_t* pixel = &image.rgba[image.at(column, row)];
      for (std::size_t c = 0; c < colour.size(); ++c) pixel[c] = channel_byte(colour[c]);
      pixel[3] = 255;
    }
}

}  // namespace

std::string legend_number(double value) {
  constexpr int kDigits = 3;
  const double size = std::abs(value);
  std::string text;
  if (size >= 1e-4 && size < 1e6) {
    const int whole = static_cast<int>(std::floor(std::log10(size))) + 1;
    text = io::fixed_text(value, std::max(0, kDigits - whole));
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
  } else {
    std::array<char, 32> digits;
    text.assign(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                             std::chars_format::general, kDigits)
                                   .ptr);
  }
  for (std::size_t at = 0; (at = text.find('-', at)) != std::string::npos;)
    text.replace(at, 1, "\u2212");
  return text;
}

LegendPainter::LegendPainter(Legend legend)
    : legend_(std::move(legend)),
      letters_(std::max(kSmallestLetters, legend_.size / 42)),
      lettering_(letters_) {
  int widest = 0;
  if (!legend_.title.empty()) {
    widest = lettering_.width(legend_.title);
    for (const Label& label : labels())
      widest = std::max(widest, 2 * letters_ + lettering_.width(label.text));
  }
  for (const LegendKey& key : legend_.keys)
    widest = std::max(widest, 2 * letters_ + lettering_.width(key.text));
  if (widest > 0) width_ = widest + letters_;
}

std::vector<LegendPainter::Label> LegendPainter::labels() const {
  return {{1, "\u2265 " + legend_number(legend_.limit) + "  " + legend_.upper},
          {0.5, legend_number(legend_.limit / 2)},
          {0, "0"},
          {-0.5, legend_number(-legend_.limit / 2)},
          {-1, "\u2264 " + legend_number(-legend_.limit) + "  " + legend_.lower}};
}

int LegendPainter::draw_bar(io::Image& image, int x, int y) const {
  const int height = legend_.size * 2 / 5;
  const int thickness = letters_ * 5 / 4;
  lettering_.draw(image, x, y, legend_.title, kInk);
  const int top = y + letters_;
  fill(image, x - 1, top - 1, thickness + 2, height + 2, kInk);
  for (int row = 0; row < height; ++row) {
    const float value =
        1 - 2 * static_cast<float>(row) / static_cast<float>(std::max(1, height - 1));
    fill(image, x, top + row, thickness, 1, colour_of(legend_.scale, value));
  }
  for (const Label& label : labels()) {
    const int row = top + static_cast<int>((1 - label.value) / 2 * (height - 1));
    fill(image, x + thickness, row, letters_ / 3, std::max(1, letters_ / 14), kInk);
    lettering_.draw(image, x + 2 * letters_, row + letters_ * 3 / 8, label.text, kInk);
  }
  return top + height + 2 * letters_;
}

void LegendPainter::draw_key(io::Image& image, int x, int y, const LegendKey& key) const {
  const int side = letters_ * 4 / 5;
  const int middle = y - letters_ * 3 / 8;
  switch (key.shape) {
    case LegendKey::Shape::kLine:
      fill(image, x, middle - letters_ / 12, letters_ * 5 / 4, std::max(2, letters_ / 6),
           key.colour);
      break;
    case LegendKey::Shape::kMark:
      for (const auto& [part, colour] : {std::pair(1.0, kInk), std::pair(0.7, key.colour)}) {
        const double radius = part * side / 2;
        for (int row = -side; row <= side; ++row)
          for (int column = -side; column <= side; ++column)
            if (row * row + column * column <= radius * radius)
              fill(image, x + side / 2 + column, middle + row, 1, 1, colour);
      }
      break;
    case LegendKey::Shape::kArea:
      fill(image, x, middle - side / 2, letters_ * 5 / 4, side, key.colour);
      break;
  }
  lettering_.draw(image, x + 2 * letters_, y, key.text, kInk);
}

void LegendPainter::draw(io::Image& image, int x) const {
  int y = 3 * letters_;
  if (!legend_.title.empty()) y = draw_bar(image, x, y);
  for (const LegendKey& key : legend_.keys) {
    draw_key(image, x, y, key);
    y += letters_ * 3 / 2;
  }
}

void LegendPainter::draw_caption(io::Image& image, int x, int panel_width,
                                 const std::string& text) const {
  const int free = panel_width - lettering_.width(text);
  lettering_.draw(image, x + std::max(0, free / 2), image.height - letters_ * 3 / 4, text, kInk);
}

}  // namespace semigeo::jobs
