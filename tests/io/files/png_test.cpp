#include "io/files/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <stdexcept>

namespace semigeo::io {
namespace {

/// Returns a picture of 3 x 2 pixels that all differ.
Image small_picture(std::uint8_t alpha) {
  Image image(3, 2);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? alpha : static_cast<std::uint8_t>(10 * i);
  return image;
}

/// Returns the pixels that libpng reads, as RGBA, and whether the file has alpha.
std::pair<Image, bool> decoded(const std::string& bytes) {
  png_image head = {};
  head.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&head, bytes.data(), bytes.size()));
  const bool alpha = (head.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  head.format = PNG_FORMAT_RGBA;
  Image image(static_cast<int>(head.width), static_cast<int>(head.height));
  EXPECT_TRUE(png_image_finish_read(&head, nullptr, image.rgba.data(), 0, nullptr));
  return {image, alpha};
}

TEST(PngTest, PixelsAreReadBackAsTheyWere) {
  for (const std::uint8_t alpha : {255, 128}) {
    const Image image = small_picture(alpha);
    const auto [read, has_alpha] = decoded(png_of(image));
    EXPECT_EQ(read.width, 3);
    EXPECT_EQ(read.height, 2);
    EXPECT_EQ(read.rgba, image.rgba);
    EXPECT_EQ(has_alpha, alpha != 255);
  }
}

TEST(PngTest, PicturesWithoutPixelsAreRefused) {
  EXPECT_THROW(png_of(Image()), std::invalid_argument);
  Image image(2, 2);
  image.rgba.pop_back();
  EXPECT_THROW(png_of(image), std::invalid_argument);
}

}  // namespace
}  // namespace semigeo::io
