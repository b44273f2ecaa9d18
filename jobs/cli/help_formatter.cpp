#include "jobs/cli/help_formatter.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "jobs/run/terminal.hpp"

namespace semigeo::jobs::cli {
namespace {

/// A column of text that is narrower than this is worse than lines that the terminal breaks.
constexpr std::size_t kNarrowest = 24;

/// Returns the words of a text in lines of at most `width` characters, if its words allow it.
std::string broken(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    if (used > 0 && used + 1 + word.size() > width) {
      result += '\n';
      used = 0;
    } else if (used > 0) {
      result += ' ';
      ++used;
    }
    result += word;
    used += word.size();
  }
  return result;
}

}  // namespace

HelpFormatter::HelpFormatter() {
  if (std::getenv("COLUMNS") != nullptr || isatty(STDOUT_FILENO) != 0)
    columns_ = terminal_columns(STDOUT_FILENO);
}

std::string HelpFormatter::make_description(const CLI::App* app) const {
  return app->get_footer() + "\n" + CLI::Formatter::make_description(app) + "\n";
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  const std::string text = CLI::Formatter::make_option_desc(option);
  if (columns_ == 0) return text;
  const std::size_t left = get_column_width();
  return broken(text, columns_ > left + kNarrowest ? columns_ - left : kNarrowest);
}

}  // namespace semigeo::jobs::cli
