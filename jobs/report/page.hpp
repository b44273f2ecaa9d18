#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "jobs/report/pages.hpp"

namespace semigeo::jobs {

/// Returns a page with its data. No text of the data can end the element that holds it or begin
/// another, because every '<' is escaped. Bytes that are not UTF-8 become U+FFFD.
std::string page_with(const PageTemplate& page, const nlohmann::json& data);

/// Returns the data of a page that `page_with` made of this template, and perhaps a line before it.
/// Returns null if the page cannot be read or is of another template.
nlohmann::json read_page_data(const std::filesystem::path& page, const PageTemplate& made_of);

/// Returns the page with a PNG as its icon.
std::string with_icon(std::string page, std::string_view png);

/// Returns the PNG that is the icon of a page, as base64, or an empty text if there is none or the
/// page cannot be read. Reads the first kB only.
std::string read_icon(const std::filesystem::path& page);

}  // namespace semigeo::jobs
