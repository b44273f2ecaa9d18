#pragma once

#include <filesystem>

namespace semigeo::jobs::cli {

/// Prints on stdout the members of a container and which of them are scans, as text or as JSON.
/// Returns an exit code.
int print_container(const std::filesystem::path& container, bool json);

}  // namespace semigeo::jobs::cli
