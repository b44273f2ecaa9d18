#pragma once

// The one place where semigeo includes HDF5's header; for the sources of io/hdf5/hdf5.hpp alone.

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <new>
#include <string>
#include <type_traits>

#include "io/hdf5/hdf5.hpp"

namespace semigeo::io {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);

/// Prepares HDF5 in this thread, so that it prints no errors and has no exit handler. It must be
/// called before any other function of the library.
void prepare_library();

/// Returns why the last call failed. Every call of the library forgets it.
std::string innermost_reason();

/// Returns the result of a call that touches no file and fails only if there is no memory. Throws
/// std::bad_alloc if it has failed.
inline std::int64_t in_memory(std::int64_t result) {
  if (result < 0) throw std::bad_alloc();
  return result;
}

/// The rows and columns of an array.
using Extent = std::array<hsize_t, 2>;

/// Returns an extent as HDF5 wants it.
inline Extent extent(std::int64_t rows, int columns) {
  return {static_cast<hsize_t>(rows), static_cast<hsize_t>(columns)};
}

/// Returns the data space (rows), or (rows, columns) if there are several columns.
inline Hdf5Handle make_space(std::int64_t rows, int columns) {
  const Extent size = extent(rows, columns);
  return {in_memory(H5Screate_simple(columns == 1 ? 1 : 2, size.data(), nullptr)), H5Sclose};
}

}  // namespace semigeo::io
