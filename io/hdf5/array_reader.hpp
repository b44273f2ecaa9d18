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
/// HDF5's filters, and hands over its rows without padding. Error names the chunk whose checksum is
/// wrong or that is missing. Memory: one chunk.
void for_each_chunk(const Hdf5File::Array& array,
                    const std::function<void(std::span<const std::byte>)>& use);

/// The same for chunks in any order, decoded and used by several threads at once: `use` is given
/// the number of each, too. Memory: some chunks.
void for_each_chunk(const Hdf5File::Array& array, const ForEach& for_each,
                    const std::function<void(std::int64_t, std::span<const std::byte>)>& use);

/// A whole array, row after row. Error unless it has this element type and number of columns, and
/// its chunks can hold what its shape promises (checked before anything is allocated).
std::vector<float> read_floats(const Hdf5File& file, const std::string& path, int columns);
std::vector<double> read_doubles(const Hdf5File& file, const std::string& path, int columns);
/// From int32 or int64.
std::vector<std::int64_t> read_integers(const Hdf5File& file, const std::string& path, int columns);

/// The rows of records as they are stored, packed.
std::vector<std::byte> read_records(const Hdf5File& file, const std::string& path,
                                    ElementType type);

}  // namespace semigeo::io
