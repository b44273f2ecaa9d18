#pragma once

#include <filesystem>

#include "jobs/archive/estimates.hpp"

namespace semigeo::jobs {

/// Returns what smoothing the first level of a dataset `levels` times is expected to need, on one
/// thread; nothing if the dataset is not there.
inline Estimate estimate_of_dataset(const std::filesystem::path& dataset, int levels,
                                    const Estimates& learned) {
  constexpr double kBytesOfVertex = 150;  // rather few bytes, so that the estimate is generous
  std::error_code error;
  const auto bytes = std::filesystem::file_size(dataset, error);
  return error ? Estimate{} : learned.of(static_cast<double>(bytes) / kBytesOfVertex, levels, 1);
}

}  // namespace semigeo::jobs
