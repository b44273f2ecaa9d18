#pragma once

#include <string>

namespace semigeo::jobs::cli {

/// The commit that the program was built from: twelve digits, with a sign if files were changed, or
/// "unknown".
extern const char* const kCommit;

/// Returns how the program was built: kind, compiler, and versions of libraries.
std::string build_text();

/// Returns what --version prints: the version alone in the first line, then commit, build and how
/// patches are traced on this machine. Throws std::invalid_argument if SEMIGEO_SIMD is wrong.
std::string version_text();

}  // namespace semigeo::jobs::cli
