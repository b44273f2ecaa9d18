#include "jobs/archive/path_text.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "io/files/utf8.hpp"

namespace semigeo::jobs {

std::string escaped(std::string_view path) {
  std::string text;
  while (!path.empty()) {
    const std::size_t bytes = io::utf8_character(path);
    if (bytes == 0 || path.front() == '%') {
      char code[4];
      std::snprintf(code, sizeof code, "%%%02X", static_cast<unsigned char>(path.front()));
      text += code;
    } else {
      text += path.substr(0, bytes);
    }
    path.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return text;
}

std::vector<std::string> escaped_all(std::vector<std::string> paths) {
  for (std::string& path : paths) path = escaped(path);
  return paths;
}

std::string unescaped(const std::string& text) {
  std::string path;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto is_digit = [&](std::size_t at) {
      return at < text.size() && std::isxdigit(static_cast<unsigned char>(text[at])) != 0;
    };
    if (text[i] == '%' && is_digit(i + 1) && is_digit(i + 2)) {
      path += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      path += text[i];
    }
  }
  return path;
}

std::vector<std::string> unescaped_all(std::vector<std::string> texts) {
  for (std::string& text : texts) text = unescaped(text);
  return texts;
}

}  // namespace semigeo::jobs
