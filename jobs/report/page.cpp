#include "jobs/report/page.hpp"

#include <nlohmann/json.hpp>

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

}  // namespace semigeo::jobs
