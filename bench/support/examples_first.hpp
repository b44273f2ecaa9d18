#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace semigeo::bench {

/// Examples, kept as the footer, stand before everything else.
class ExamplesFirst : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override {
    return app->get_footer() + "\n" + CLI::Formatter::make_description(app) + "\n";
  }
  std::string make_footer(const CLI::App*) const override { return ""; }
};

}  // namespace semigeo::bench
