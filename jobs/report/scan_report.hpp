#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "io/dataset/dataset.hpp"

namespace semigeo::jobs {

/// The version of what a scan's page shows. It is part of the page's key.
inline constexpr std::string_view kScanPageVersion = "scan page 4";

/// Says how much of a dataset a page gets, so that the page stays below 6 MB.
struct ScanPageLimits {
  std::int64_t levels = 16;       ///< Levels that are shown; the others are passed over evenly.
  std::int64_t vertices = 40000;  ///< Vertices of one level that are shown, at most (65,536).
  double bytes = 5.0e6;           ///< Size of the data of all levels, at most, about.
};

/// Returns what the page of a scan shows of its dataset: header, selection and levels.
///
/// A level is decimated (jobs/report/shown_surface.hpp) if it has more vertices than the limits
/// admit; its fields are those of the vertices that are left. Arrays are base64 of little-endian
/// numbers: positions are 16-bit fractions of the level's box, curvatures are floats (NaN at
/// vertices without a valid patch), completeness is in 255ths. Features are the most prominent of
/// each kind, and points of contours are thinned out, if there are more of them than vertices.
/// `limits` of a level are the 98th percentiles of |K| and |H| over its valid vertices, and
/// `histograms` count the values between minus and plus these limits.
///
/// Keeps one level in memory. The cost is that of reading the levels and of `decimated`. Throws
/// io::Error if the dataset cannot be read.
nlohmann::json scan_report(const io::Dataset& dataset, const ScanPageLimits& limits = {});

}  // namespace semigeo::jobs
