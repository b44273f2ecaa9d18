#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <string>

namespace semigeo::io {

/// Says where a dataset comes from. Its fields are attributes of the root; the JSON values are
/// stored as text, as `dump()` gives it.
struct DatasetHeader {
  /// All that was chosen, or is the default.
  nlohmann::json parameters = nlohmann::json::object();
  std::string input_name;  ///< Path of the scan below the folder that was searched, as UTF-8.
  std::string input_xxh3;  ///< XXH3_128 of the scan's bytes, 32 hexadecimal digits.
  std::string job_key;     ///< Hash of everything that the content depends on.
  std::string length_unit = "unknown";
  nlohmann::json repairs = nlohmann::json::object();      ///< Counts of what was dropped or welded.
  nlohmann::json preparation = nlohmann::json::object();  ///< What was filled or decimated.
  std::array<double, 3> origin = {0, 0, 0};  ///< It is added to the points to get the scan's own.
};

}  // namespace semigeo::io
