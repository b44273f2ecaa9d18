#pragma once

#include <concepts>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/number_text.hpp"
#include "io/files/printable.hpp"

namespace semigeo::jobs::cli {

// Everything that a command prints goes through these functions. So no name of a file reaches the
// terminal with characters that steer it, and no number loses digits.

/// Returns a text that stands in the code, as it is.
template <std::size_t N>
std::string part_text(const char (&literal)[N]) {
  return {literal, N - 1};
}
/// Returns a name or a message, as io::printable shows it.
inline std::string part_text(std::string_view name) {
  return io::printable(name);
}
inline std::string part_text(const std::string& name) {
  return io::printable(name);
}
inline std::string part_text(const std::filesystem::path& path) {
  return io::printable(path.native());
}
/// Returns the message of an exception in the same way.
inline std::string part_text(const std::exception& e) {
  return io::printable(e.what());
}
/// Returns a number, as io::number_text shows it if it is not whole.
template <typename Number>
requires std::integral<Number> || std::floating_point<Number> std::string part_text(Number value) {
  if constexpr (std::integral<Number>) return std::to_string(value);
  if constexpr (std::floating_point<Number>) return io::number_text(value);
}

/// Returns the parts of a line for people, one after the other.
template <typename... Parts>
std::string line_of(const Parts&... parts) {
  return (std::string() + ... + part_text(parts));
}

/// Prints on stdout a text whose names are printable already.
void print_text(std::string_view text);
/// Prints on stderr a text whose names are printable already.
void print_error(std::string_view text);

/// Prints on stdout the parts of a text for people.
template <typename... Parts>
void print(const Parts&... parts) {
  print_text(line_of(parts...));
}

/// Prints a line on stderr that begins with the name of the program.
template <typename... Parts>
void complain(const Parts&... parts) {
  print_error("semigeo: " + line_of(parts...) + "\n");
}

/// Returns a word, such as a path, as a shell takes it: in quotes if need be.
std::string shell_word(const std::string& text);

/// Returns a number of things in words: "1 scan", "2 scans". `one` is the word for one of them.
std::string counted(std::size_t count, std::string_view one);

/// Returns the text with spaces behind it, so that it has at least `width` characters.
std::string padded(std::string text, std::size_t width);

/// Returns the rows as lines whose columns stand below each other, two spaces apart, `indent`
/// spaces from the left. `alignment` has a letter for each column: the cells of an 'r' column end
/// below each other, those of an 'l' column begin there. The cells must be printable.
std::string table_text(const std::vector<std::vector<std::string>>& rows, std::size_t indent,
                       std::string_view alignment);

}  // namespace semigeo::jobs::cli
