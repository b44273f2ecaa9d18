#pragma once

#include <span>
#include <string>

#include "io/vtkhdf.hpp"

namespace semigeo::io {

/// The XDMF sidecar of a dataset, for viewers that do not know temporal VTKHDF: one grid per level
/// in a temporal collection, referring to the arrays under /levels. `dataset_name` is the name of
/// the dataset's file, which must lie in the same folder.
std::string xdmf_text(const std::string& dataset_name, std::span<const VtkhdfStep> steps);

}  // namespace semigeo::io
