#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// Knows of which scan each dataset of an archive was made. ARCHIVE/sources.json maps the name of
/// the dataset to the absolute path of the scan. Because of it, two folders with files of the same
/// name do not replace each other's datasets. Nothing else depends on it, and no dataset holds a
/// path.
class Sources {
 public:
  /// Reads the archive's file. The result is empty if there is no such file. Throws io::Error if
  /// the file is damaged.
  static Sources read(const std::filesystem::path& archive);

  const std::map<std::string, std::filesystem::path>& by_name() const { return by_name_; }
  /// Gives the name to a scan, unless it belongs to another scan that still exists.
  void claim(const std::string& name, const std::filesystem::path& scan);
  /// Frees the name.
  void forget(const std::string& name) { by_name_.erase(name); }
  /// Replaces the archive's file if its content is different.
  void write(const std::filesystem::path& archive) const;

 private:
  std::map<std::string, std::filesystem::path> by_name_;
};

/// Returns whether the scan, or the container that it is a member of, is gone. A scan about which
/// nothing can be known is not gone.
bool is_gone(const std::filesystem::path& scan);

/// A scan that needs a name.
struct Unnamed {
  std::string base;            ///< The name that it gets unless another scan has it.
  std::filesystem::path scan;  ///< Absolute path, the same for every path to one file.
  std::string xxh3;            ///< Digest of its bytes; empty if it cannot be read.
};

/// Returns a name for each scan. All names are different, and they do not depend on the order of
/// the scans. A scan gets the first of these names that is free:
///
///   1. the name under which the archive knows it
///   2. a name whose dataset was made of the same bytes
///   3. the base, if the archive does not know it, or if the scan that had it is gone
///   4. the base, "--" and a hash of the scan's path
///
/// `is_of(name, xxh3)` says whether the archive has a complete dataset of this name and bytes.
std::vector<std::string> choose_names(
    const std::vector<Unnamed>& scans, const Sources& sources,
    const std::function<bool(const std::string& name, const std::string& xxh3)>& is_of);

}  // namespace semigeo::jobs
