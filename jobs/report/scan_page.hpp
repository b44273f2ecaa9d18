#pragma once

#include <filesystem>

#include "io/dataset/dataset.hpp"
#include "jobs/report/pages.hpp"

namespace semigeo::jobs {

/// Makes the page of a scan, which appears whole. Leaves it alone if it is up to date: its first
/// line holds a key of the dataset's digest and of the page without its data. Returns whether the
/// page was made. Throws io::Error if the dataset cannot be read or the page cannot be written.
bool make_scan_page(const io::Dataset& dataset, const PageTemplate& page,
                    const std::filesystem::path& path);

}  // namespace semigeo::jobs
