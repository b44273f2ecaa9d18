#include "jobs/cli/output.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace semigeo::jobs::cli {
namespace {

constexpr std::string_view kGap = "  ";

std::string spaces(const std::string& text, std::size_t width) {
  const std::size_t length = io::count_characters(text);
  return std::string(width > length ? width - length : 0, ' ');
}

}  // namespace

void print_text(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void print_error(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
}

std::string shell_word(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 ||
           std::string_view("/._-+=:,@").find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::ranges::all_of(text, is_plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + '\'';
}

std::string counted(std::size_t count, std::string_view one) {
  return std::to_string(count) + " " + std::string(one) + (count == 1 ? "" : "s");
}

std::string padded(std::string text, std::size_t width) {
  const std::string behind = spaces(text, width);
  return text += behind;
}

std::string table_text(const std::vector<std::vector<std::string>>& rows, std::size_t indent,
                       std::string_view alignment) {
  std::vector<std::size_t> widths(alignment.size());
  for (const std::vector<std::string>& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], io::count_characters(row[i]));
  std::string text;
  for (const std::vector<std::string>& row : rows) {
    std::string line(indent, ' ');
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) line += kGap;
      line += alignment[i] == 'r' ? spaces(row[i], widths[i]) + row[i] : padded(row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

}  // namespace semigeo::jobs::cli
