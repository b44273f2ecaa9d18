#pragma once

#include <filesystem>

#include "engine/resources.hpp"

namespace semigeo::engine {

/// What this process can use now of the machine it runs on: the cores it may run on, as far as the
/// CPU quotas of its control groups let it use them; the memory that is available without swapping,
/// as far as its control groups leave it any. At least one core; 0 bytes if Linux does not say.
/// Control groups of version 1 and 2, and all that enclose the process's own. `root` is where /proc
/// and /sys are found.
Amount usable_resources(const std::filesystem::path& root = "/");

}  // namespace semigeo::engine
