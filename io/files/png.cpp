#include "io/files/png.hpp"

#include <png.h>

#include <stdexcept>
#include <vector>

namespace semigeo::io {
namespace {

bool is_opaque(const Image& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4)
    if (image.rgba[i] != 255) return false;
  return true;
}

/// Returns the pixels without alpha.
std::vector<std::uint8_t> colours_of(const Image& image) {
  std::vector<std::uint8_t> colours;
  colours.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    colours.insert(colours.end(), &image.rgba[i], &image.rgba[i] + 3);
  return colours;
}

}  // namespace

std::string png_of(const Image& image) {
  if (image.width <= 0 || image.height <= 0 || image.rgba.size() != image.at(0, image.height))
    throw std::invalid_argument("png_of: a picture without pixels, or of another size");
  const bool opaque = is_opaque(image);
  const std::vector<std::uint8_t> pixels = opaque ? colours_of(image) : image.rgba;

  png_image head = {};
  head.version = PNG_IMAGE_VERSION;
  head.width = static_cast<png_uint_32>(image.width);
  head.height = static_cast<png_uint_32>(image.height);
  head.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(head);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&head, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw std::runtime_error(std::string("libpng cannot write a picture: ") + head.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace semigeo::io
