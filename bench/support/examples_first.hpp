#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace semigeo::bench {

/// Formats help texts. The examples, which a command has as its footer, are printed first.
class ExamplesFirst : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override {
    return app->get_footer() + "\n" + CLI::Formatter::make_description(app) + "\n";
  }
  std::string make_footer(const CLI::App*) const override { return ""; }
};

}  // namespace semigeo::bench
