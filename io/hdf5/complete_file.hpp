#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {

/// A kind of HDF5 file of ours: what its root's attributes `format` and `format_version` say.
struct FileFormat {
  const char* name;      ///< "semigeo-dataset"
  std::int64_t version;  ///< the one that this program reads
  const char* noun;      ///< as messages have it: "dataset"
  const char* remedy;    ///< what to do if it is another kind of file
};

/// Begins a file: format, version, creator.
void write_format(DigestedFile& file, const FileFormat& format);

/// Opens a file for reading; refuses other formats, other versions, and unfinished files.
Hdf5File open_complete(const std::filesystem::path& path, const FileFormat& format);

/// Returns the JSON that a text attribute of the root holds. Error if it is none.
nlohmann::json read_json_attribute(const Hdf5File& file, const std::string& name);

/// Ends a file that is written under the temporary name of `target`: the digest, `complete`. Then
/// `verify` reads it from the path that it is given, while it goes to the disk, and returns the
/// digest that it found stored. What it throws becomes an Error that names the final file. Returns
/// the digest; `target` is left to be committed.
std::string complete_file(DigestedFile& file, AtomicFile& target,
                          const std::function<std::string(const std::filesystem::path&)>& verify);

}  // namespace semigeo::io
