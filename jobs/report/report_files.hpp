#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "jobs/report/pages.hpp"

namespace semigeo::jobs {

/// The words by which the journal names the jobs that make pages.
inline constexpr std::string_view kPageKind = "page";
inline constexpr std::string_view kScenePageKind = "scene";
inline constexpr std::string_view kReportKind = "report";

/// Returns whether the name of a job in the journal is that of a job that makes a page.
bool makes_page(std::string_view job);

/// Returns the page of the scan of this name, in the folder of a report.
std::filesystem::path scan_page_path(const std::filesystem::path& folder, const std::string& name);
/// Returns the page of the recognised scene of this name.
std::filesystem::path scene_page_path(const std::filesystem::path& folder, const std::string& name);
/// Returns the first page.
std::filesystem::path index_path(const std::filesystem::path& folder);

/// Returns a hash of the version of a kind of page, of the page without its data, and of what it
/// shows.
std::string page_key(std::string_view version, const PageTemplate& page, std::string_view content);

/// Returns the key in the first line of a page. Throws io::Error if the file cannot be read or is
/// no page of a report.
std::string read_page_key(const std::filesystem::path& path);

/// Writes a page, which appears whole. Its first line holds the key. Throws io::Error if it cannot
/// be written.
void write_page(const std::filesystem::path& path, const std::string& key, std::string_view text);

}  // namespace semigeo::jobs
