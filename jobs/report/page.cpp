#include "jobs/report/page.hpp"

#include <nlohmann/json.hpp>
#include <span>

#include "io/files/base64.hpp"
#include "io/files/error.hpp"
#include "io/files/input_file.hpp"

namespace semigeo::jobs {

std::string page_with(const PageTemplate& page, const nlohmann::json& data) {
  const std::string json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string text;
  text.reserve(page.before.size() + json.size() + page.behind.size());
  text += page.before;
  // JSON has '<' in strings only, where it may be escaped.
  for (const char c : json) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  text += page.behind;
  return text;
}

nlohmann::json read_page_data(const std::filesystem::path& page, const PageTemplate& made_of) {
  try {
    const io::InputFile file(page);
    std::string text(static_cast<std::size_t>(file.size()), '\0');
    text.resize(file.read_at(0, text));
    const std::size_t before = text.find(made_of.before);
    if (before == std::string::npos || !text.ends_with(made_of.behind)) return nullptr;
    const std::size_t begin = before + made_of.before.size();
    const std::size_t end = text.size() - made_of.behind.size();
    if (end < begin) return nullptr;
    return nlohmann::json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                 text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
  } catch (const io::Error&) {
    return nullptr;
  }
}

static constexpr std::string_view kNoIcon = "rel=\"icon\" href=\"data:,\"";
static constexpr std::string_view kIcon = "rel=\"icon\" href=\"data:image/png;base64,";

std::string with_icon(std::string page, std::string_view png) {
  const std::size_t at = page.find(kNoIcon);
  if (at == std::string::npos) return page;
  const std::string icon = std::string(kIcon) + io::base64(std::as_bytes(std::span(png))) + '"';
  return page.replace(at, kNoIcon.size(), icon);
}

std::string read_icon(const std::filesystem::path& page) {
  constexpr std::size_t kMostBytes = 32 << 10;
  try {
    const io::InputFile file(page);
    std::string text(kMostBytes, '\0');
    text.resize(file.read_at(0, text));
    const std::size_t at = text.find(kIcon);
    if (at == std::string::npos) return "";
    const std::size_t begin = at + kIcon.size();
    const std::size_t end = text.find('"', begin);
    return end == std::string::npos ? "" : text.substr(begin, end - begin);
  } catch (const io::Error&) {
    return "";
  }
}

}  // namespace semigeo::jobs
