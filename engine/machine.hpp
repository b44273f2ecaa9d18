#pragma once

#include <filesystem>

#include "engine/resources.hpp"

namespace semigeo::engine {

/// Returns what this process can use now of the machine that it runs on: the cores that it may run
/// on, as far as the CPU quotas of its control groups let it use them, and the memory that is
/// available without swapping, as far as its control groups leave it any. There is at least one
/// core; memory is 0 bytes if Linux does not say. Control groups of version 1 and 2 count, and all
/// that enclose the process's own. `root` is the folder in which /proc and /sys are found.
Amount usable_resources(const std::filesystem::path& root = "/");

}  // namespace semigeo::engine
