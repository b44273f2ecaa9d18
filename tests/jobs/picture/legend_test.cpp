#include "jobs/picture/legend.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace semigeo::jobs {
namespace {

io::Image white(int width, int height) {
  io::Image image(width, height);
  std::ranges::fill(image.rgba, std::uint8_t{255});
  return image;
}

/// Returns whether some pixel of the columns from `first` on is not white.
bool is_drawn(const io::Image& image, int first, int last) {
  for (int y = 0; y < image.height; ++y)
    for (int x = first; x < last; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        if (image.rgba[image.at(x, y) + c] != 255) return true;
  return false;
}

TEST(LegendNumberTest, HasThreeSignificantDigitsWithoutZerosBehindThem) {
  EXPECT_EQ(legend_number(0.435988), "0.436");
  EXPECT_EQ(legend_number(1035.5273), "1036");
  EXPECT_EQ(legend_number(78.034), "78");
  EXPECT_EQ(legend_number(9.999), "10");
  EXPECT_EQ(legend_number(0), "0");
  EXPECT_EQ(legend_number(-2.5), "\u22122.5");
  EXPECT_EQ(legend_number(0.000412), "0.000412");
  EXPECT_EQ(legend_number(4.1234e-7), "4.12e\u221207");
  EXPECT_EQ(legend_number(1.5e9), "1.5e+09");
}

TEST(LettersTest, WiderTextTakesMoreRoom) {
  const Lettering lettering(20);
  EXPECT_EQ(lettering.width(""), 0);
  EXPECT_GT(lettering.width("mm"), lettering.width("m"));
  EXPECT_GT(lettering.width("\u03c3"), 0);
  EXPECT_GT(lettering.width("\xff"), 0);  // no text, but a box
}

TEST(LettersTest, LettersStandOnTheirLineAndInThePicture) {
  io::Image image = white(40, 30);
  const Lettering lettering(16);
  lettering.draw(image, 10, 20, "H", {0, 0, 0});
  EXPECT_FALSE(is_drawn(image, 0, 10));
  EXPECT_TRUE(is_drawn(image, 10, 10 + lettering.width("H")));
  for (int x = 0; x < image.width; ++x) EXPECT_EQ(image.rgba[image.at(x, 21)], 255) << x;
  lettering.draw(image, 35, -3, "beyond", {0, 0, 0});
}

TEST(LegendPainterTest, TakesNoRoomWithoutContent) {
  Legend legend;
  EXPECT_EQ(LegendPainter(legend).width(), 0);
  legend.keys.push_back({"K = 0", {0, 0, 0}, LegendKey::Shape::kLine});
  EXPECT_GT(LegendPainter(legend).width(), 0);
}

TEST(LegendPainterTest, TheBarGoesFromLowToHigh) {
  Legend legend;
  legend.size = 400;
  legend.title = "H in 1/mm";
  legend.limit = 2;
  const LegendPainter painter(legend);
  io::Image image = white(painter.width(), 400);
  painter.draw(image, 0);
  int first_blue = -1;
  int last_orange = -1;
  for (int y = 60; y < 400; ++y) {
    const std::uint8_t* pixel = &image.rgba[image.at(4, y)];
    if (pixel[0] > pixel[2] + 40) last_orange = y;
    if (pixel[2] > pixel[0] + 40 && first_blue < 0) first_blue = y;
  }
  EXPECT_GT(last_orange, 0);
  EXPECT_LT(last_orange, first_blue);
}

}  // namespace
}  // namespace semigeo::jobs
