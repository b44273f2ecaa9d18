#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "io/files/atomic_file.hpp"
#include "io/hdf5/content_digest.hpp"

namespace semigeo::io {

/// Describes a kind of HDF5 file of ours: what its root's attributes `format` and `format_version`
/// say.
struct FileFormat {
  const char* name;      ///< Value of `format`: "semigeo-dataset".
  std::int64_t version;  ///< The version that this program reads.
  const char* noun;      ///< Name of the kind in messages: "dataset".
  const char* remedy;    ///< What to do if it is another kind of file.
};

/// Begins a file: writes format, version and creator.
void write_format(DigestedFile& file, const FileFormat& format);

/// Opens a file for reading. Throws Error on other formats, other versions, and unfinished files.
Hdf5File open_complete(const std::filesystem::path& path, const FileFormat& format);

/// Returns the JSON that a text attribute of the root holds. Throws Error if the text is no JSON.
nlohmann::json read_json_attribute(const Hdf5File& file, const std::string& name);

/// Ends a file that is written under the temporary name of `target`: writes the digest and
/// `complete`. Then `verify` reads it from the path that it is given, while another thread forces
/// the file to the disk, and returns the digest that it found stored. An exception of `verify`
/// becomes an Error that names the final file. Returns the digest; `target` is left to be
/// committed.
std::string complete_file(DigestedFile& file, AtomicFile& target,
                          const std::function<std::string(const std::filesystem::path&)>& verify);

}  // namespace semigeo::io
