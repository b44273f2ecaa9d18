#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/hdf5/for_each.hpp"
#include "io/hdf5/hdf5_array.hpp"

namespace semigeo::io {

/// Reads, checks and decodes one chunk after the other with our own codec, several times as fast as
/// HDF5's filters, and hands over its rows without padding. Throws Error, which names the chunk, if
/// a checksum is wrong or the chunk is missing. It keeps one chunk in memory.
void for_each_chunk(const Hdf5File::Array& array,
                    const std::function<void(std::span<const std::byte>)>& use);

/// Reads chunks in any order, decoded and used by several threads at once. `use` is also given the
/// number of each chunk. It keeps several chunks in memory.
void for_each_chunk(const Hdf5File::Array& array, const ForEach& for_each,
                    const std::function<void(std::int64_t, std::span<const std::byte>)>& use);

/// Reads a whole array of float32, row after row. Throws Error if it has another element type or
/// number of columns, or if its chunks cannot hold what its shape promises. That is checked before
/// memory is allocated.
std::vector<float> read_floats(const Hdf5File& file, const std::string& path, int columns);
/// Reads a whole array of float64 in the same way.
std::vector<double> read_doubles(const Hdf5File& file, const std::string& path, int columns);
/// Reads a whole array of int32 or int64 in the same way.
std::vector<std::int64_t> read_integers(const Hdf5File& file, const std::string& path, int columns);

/// Reads the rows of records as they are stored, packed.
std::vector<std::byte> read_records(const Hdf5File& file, const std::string& path,
                                    ElementType type);

}  // namespace semigeo::io
