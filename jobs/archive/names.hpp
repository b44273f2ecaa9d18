#pragma once

#include <filesystem>
#include <string>

namespace semigeo::jobs {

/// Returns the name of the dataset of a scan, from its path below the folder in which it was found.
/// Folders are joined by "__", and anything but letters, digits, '.', '-' and '_' is replaced. A
/// name that could be misread ends in a hash of the path.
std::string dataset_name(const std::filesystem::path& relative);

/// Returns the name that a scan gets if another scan has its base: the base, "--" and a hash of the
/// scan's path.
std::string name_with_hash(const std::string& base, const std::filesystem::path& scan);

/// Returns whether a name is the base, or the base with a hash.
bool is_variant(const std::string& name, const std::string& base);

/// Returns how people call the scan whose dataset has this name: by its path below the folder in
/// which it was found, "box.zip/part/a.ply". If the name has a hash because another scan has the
/// same path, the name stands behind it in brackets. `scan` is any path to the scan.
std::string given_name(const std::filesystem::path& scan, const std::string& name);

}  // namespace semigeo::jobs
