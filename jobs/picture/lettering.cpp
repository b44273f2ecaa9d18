#include "jobs/picture/lettering.hpp"

#include <ft2build.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "io/files/utf8.hpp"
#include FT_FREETYPE_H

extern "C" {
// NOLINTBEGIN(readability-identifier-naming): as the assembler spells them
extern const unsigned char semigeo_font_begin[];
extern const unsigned char semigeo_font_end[];
// NOLINTEND(readability-identifier-naming)
}

namespace semigeo::jobs {
namespace {

/// Returns whether a call of FreeType has worked. Throws std::bad_alloc if there was no memory for
/// it.
bool worked(FT_Error error) {
  if (FT_ERROR_BASE(error) == FT_Err_Out_Of_Memory) throw std::bad_alloc();
  return error == 0;
}

}  // namespace

struct Lettering::Font {
  explicit Font(int size) {
    if (FT_Init_FreeType(&library) != 0) throw std::bad_alloc();
    try {
      if (!worked(FT_New_Memory_Face(library, semigeo_font_begin,
                                     semigeo_font_end - semigeo_font_begin, 0, &face)) ||
          !worked(FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size))))
        throw std::runtime_error("the font of this program cannot be read");
    } catch (...) {
      FT_Done_FreeType(library);
      throw;
    }
  }
  ~Font() { FT_Done_FreeType(library); }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  /// Loads a character with its bitmap, or returns null.
  FT_GlyphSlot load(FT_ULong code) const {
    return worked(FT_Load_Char(face, code, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT)) ? face->glyph
                                                                                   : nullptr;
  }

  FT_Library library = nullptr;
  FT_Face face = nullptr;
};

Lettering::Lettering(int size) : font_(std::make_unique<Font>(size)) {}
Lettering::~Lettering() = default;

int Lettering::width(std::string_view text) const {
  FT_Pos width = 0;  // in 64ths of a pixel
  while (!text.empty())
    if (const FT_GlyphSlot glyph = font_->load(io::take_utf8_character(text)); glyph != nullptr)
      width += glyph->advance.x;
  return static_cast<int>((width + 63) / 64);
}

void Lettering::draw(io::Image& image, int x, int y, std::string_view text,
                     const Colour& colour) const {
  FT_Pos pen = FT_Pos{64} * x;
  while (!text.empty()) {
    const FT_GlyphSlot glyph = font_->load(io::take_utf8_character(text));
    if (glyph == nullptr) continue;
    const FT_Bitmap& bitmap = glyph->bitmap;
    for (int row = 0; row < static_cast<int>(bitmap.rows); ++row)
      for (int column = 0; column < static_cast<int>(bitmap.width); ++column) {
        const int to_x = static_cast<int>(pen / 64) + glyph->bitmap_left + column;
        const int to_y = y - glyph->bitmap_top + row;
        if (to_x < 0 || to_x >= image.width || to_y < 0 || to_y >= image.height) continue;
        const float ink = static_cast<float>(bitmap.buffer[row * bitmap.pitch + column]) / 255;
        std::uint8_t* pixel = &image.rgba[image.at(to_x, to_y)];
        for (std::size_t c = 0; c < colour.size(); ++c)
          pixel[c] = channel_byte((1 - ink) * static_cast<float>(pixel[c]) / 255 + ink * colour[c]);
        pixel[3] = static_cast<std::uint8_t>(std::max<float>(pixel[3], 255 * ink));
      }
    pen += glyph->advance.x;
  }
}

}  // namespace semigeo::jobs
