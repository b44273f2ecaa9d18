#include "io/files/small_file.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/input_file.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 16;

/// Looks over the text of a JSON object, piece by piece.
class Brackets {
 public:
  explicit Brackets(int most) : most_(most) {}

  /// Returns whether the text so far can be the beginning of an object whose brackets are not too
  /// deep inside each other.
  bool allow(std::string_view piece) {
    return std::ranges::all_of(piece, [this](char c) { return allow(c); });
  }

 private:
  bool allow(char c) {
    if (std::exchange(escaped_, false)) return true;
    if (in_string_) {
      escaped_ = c == '\\';
      in_string_ = c != '"';
      return true;
    }
    if (!begun_ && c != '{') return c == ' ' || c == '\n' || c == '\t' || c == '\r';
    begun_ = true;
    in_string_ = c == '"';
    if (c == '[' || c == '{') return ++depth_ <= most_;
    if (c == ']' || c == '}') --depth_;
    return true;
  }

  int most_;
  int depth_ = 0;
  bool begun_ = false;
  bool in_string_ = false;
  bool escaped_ = false;
};

InputFile open_bounded(const std::filesystem::path& path, const TextBounds& bounds) {
  InputFile file(path);
  if (file.size() > bounds.bytes)
    throw Error(path, "",
                "has " + std::to_string(file.size()) + " bytes, and such a file has at most " +
                    std::to_string(bounds.bytes),
                "check where it comes from");
  return file;
}

}  // namespace

std::string read_text(const std::filesystem::path& path, const TextBounds& bounds) {
  InputFile file = open_bounded(path, bounds);
  // A file that grows meanwhile is read as far as it was.
  std::string text(static_cast<std::size_t>(file.size()), '\0');
  text.resize(file.read(text));
  return text;
}

nlohmann::json parse_json(const std::string& text, const TextBounds& bounds) {
  if (!Brackets(bounds.depth).allow(text)) return nlohmann::json::value_t::discarded;
  return nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json read_json(const std::filesystem::path& path, const TextBounds& bounds) {
  InputFile file = open_bounded(path, bounds);
  Brackets brackets(bounds.depth);
  std::string text;
  std::string piece(kPieceBytes, '\0');
  while (const std::size_t got = file.read(piece)) {
    const std::string_view read = std::string_view(piece).substr(0, got);
    if (!brackets.allow(read)) return nlohmann::json::value_t::discarded;
    text += read;
    if (static_cast<std::int64_t>(text.size()) > bounds.bytes) break;  // it has grown meanwhile
  }
  return nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
}

bool has_text(const std::filesystem::path& path, std::string_view text) {
  try {
    return read_text(path, {.bytes = static_cast<std::int64_t>(text.size())}) == text;
  } catch (const Error&) {
    return false;
  }
}

void write_if_different(const std::filesystem::path& path, std::string_view text) {
  if (!has_text(path, text)) write_file_atomically(path, text);
}

}  // namespace semigeo::io
