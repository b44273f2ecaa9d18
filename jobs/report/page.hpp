#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "jobs/report/pages.hpp"

namespace semigeo::jobs {

/// Returns a page with its data. No text of the data can end the element that holds it or begin
/// another, because every '<' is escaped. Bytes that are not UTF-8 become U+FFFD.
std::string page_with(const PageTemplate& page, const nlohmann::json& data);

}  // namespace semigeo::jobs
