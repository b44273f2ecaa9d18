#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/dataset/vtkhdf.hpp"

namespace semigeo::io {

/// Returns the XDMF sidecar of a dataset, for viewers that do not know temporal VTKHDF: one grid
/// for each level in a temporal collection, referring to the arrays under /levels. `dataset_name`
/// is the name of the dataset's file, which must lie in the same folder.
std::string xdmf_text(const std::string& dataset_name, std::span<const VtkhdfStep> steps);

/// Returns where the sidecar of a dataset lies.
std::filesystem::path sidecar_of(const std::filesystem::path& dataset);

/// Returns what the sidecar of a dataset must say, from the dataset's attributes and sizes. Throws
/// Error if the dataset is damaged.
std::string sidecar_text(const std::filesystem::path& dataset);

}  // namespace semigeo::io
