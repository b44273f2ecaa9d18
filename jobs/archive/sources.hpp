#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace semigeo::jobs {

/// Which scan each dataset of an archive was made of: ARCHIVE/sources.json, dataset name to
/// absolute path. It keeps two folders that hold files of the same name from replacing each
/// other's datasets. Nothing else depends on it, and no dataset holds a path.
class Sources {
 public:
  /// What the archive knows; empty if it has no such file. io::Error if the file is damaged.
  static Sources read(const std::filesystem::path& archive);

  const std::map<std::string, std::filesystem::path>& by_name() const { return by_name_; }
  /// Enters a scan, unless the name is known for another that still exists.
  void claim(const std::string& name, const std::filesystem::path& scan);
  /// Replaces the archive's file, if it would say something else.
  void write(const std::filesystem::path& archive) const;

 private:
  std::map<std::string, std::filesystem::path> by_name_;
};

/// A scan that wants a name.
struct Unnamed {
  std::string base;            ///< the name it has unless another scan has it
  std::filesystem::path scan;  ///< absolute; the same for every path to one file
  std::string xxh3;            ///< of its bytes; empty if it cannot be read
};

/// One name each, all different, whatever the order of the scans: the name that the archive knows
/// the scan by; else one whose dataset is of the same bytes; else the base, if the archive does not
/// know it or the scan it knows it by is gone; else the base, "--" and a hash of the scan's path.
/// `is_of(name, xxh3)` says whether the archive has a complete dataset of this name and bytes.
std::vector<std::string> choose_names(
    const std::vector<Unnamed>& scans, const Sources& sources,
    const std::function<bool(const std::string& name, const std::string& xxh3)>& is_of);

}  // namespace semigeo::jobs
