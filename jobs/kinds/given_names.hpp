#pragma once

#include <filesystem>
#include <string>

#include "jobs/archive/sources.hpp"

namespace semigeo::jobs {

/// Knows the files of which the models of an archive's library were made. Names of models are safe
/// names of datasets ("____7.ply-f838e8b1"); people know their scans by the names that they gave
/// ("像 7.ply").
class GivenNames {
 public:
  /// Reads which scans the archive of the library has. It knows nothing about a library elsewhere,
  /// or if the record cannot be read.
  explicit GivenNames(const std::filesystem::path& library);

  /// Returns the path of the model's scan; empty if it is not known.
  std::filesystem::path scan_of(const std::string& model) const;
  /// Returns how people call the scan of the model (given_name), or the name of the model if its
  /// scan is not known.
  std::string name_of(const std::string& model) const;
  /// Returns what people call the scan, and behind it the name of the model if that is another:
  /// "像 7.ply (____7.ply-f838e8b1)".
  std::string shown(const std::string& model) const;

 private:
  Sources sources_;
};

}  // namespace semigeo::jobs
