#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace semigeo::jobs::cli {

/// Adds an option that takes one of the words. The place of the word is the value.
template <typename Value, std::size_t N>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const std::array<std::string_view, N>& words, const std::string& help) {
  const std::vector<std::string> all(words.begin(), words.end());
  return app
      .add_option_function<std::string>(
          name,
          [&value, all](const std::string& word) {
            value = static_cast<Value>(std::ranges::find(all, word) - all.begin());
          },
          help)
      ->default_str(all[static_cast<std::size_t>(value)])
      ->check(CLI::IsMember(all));
}

}  // namespace semigeo::jobs::cli
