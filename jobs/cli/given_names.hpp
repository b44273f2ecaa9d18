#pragma once

#include <filesystem>
#include <string>

#include "jobs/archive/sources.hpp"

namespace semigeo::jobs::cli {

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
  /// Returns the model for people: its name, after the file name of its scan if the name of the
  /// model does not end with it: "像 7.ply (____7.ply-f838e8b1)".
  std::string shown(const std::string& model) const;

 private:
  Sources sources_;
};

}  // namespace semigeo::jobs::cli
