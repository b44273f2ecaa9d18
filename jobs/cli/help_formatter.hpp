#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace semigeo::jobs::cli {

/// Writes help. The examples, which are kept as the footer, stand before everything else. On a
/// terminal, or if COLUMNS is set, descriptions of options are broken to its width.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App*) const override { return ""; }
  std::string make_option_desc(const CLI::Option* option) const override;

 private:
  std::size_t columns_ = 0;  ///< 0: lines are left as they are.
};

}  // namespace semigeo::jobs::cli
