#include "jobs/archive/find_scans.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/scans/scan_reader.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSuffixDigits = 8;
constexpr std::size_t kMaxNameLength = 180;

std::string short_hash(const std::string& text) {
  return io::xxh3_of_text(text).substr(0, kSuffixDigits);
}

bool is_safe(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
}

/// Returns whether "__" in the name could come from anything but the joining of folders.
bool has_misleading_underscore(const std::string& path) {
  return path.find("__") != std::string::npos || path.find("_/") != std::string::npos ||
         path.find("/_") != std::string::npos;
}

std::string dataset_name(const fs::path& relative) {
  const std::string path = relative.generic_string();
  std::string name;
  bool exact = !has_misleading_underscore(path);
  for (const char c : path) {
    if (c == '/') {
      name += "__";
    } else if (is_safe(c)) {
      name += c;
    } else {
      name += '_';
      exact = false;
    }
  }
  if (name.size() > kMaxNameLength) {
    name = name.substr(name.size() - kMaxNameLength);
    exact = false;
  }
  if (name.starts_with('.')) {  // a hidden dataset would be passed over
    name.front() = '_';
    exact = false;
  }
  return exact ? name : name + "-" + short_hash(path);
}

bool is_hidden(const fs::path& path) {
  return path.filename().string().starts_with('.');
}

/// Returns the same path for every path to one file. Broken and circular links keep their own path.
fs::path identity(const fs::path& file) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(file, error);
  return error ? fs::absolute(file).lexically_normal() : canonical;
}

FoundScan found_scan(const fs::path& input, const fs::path& relative) {
  return {input, relative.generic_string(), dataset_name(relative), identity(input), ""};
}

io::Error unsearchable(const fs::path& folder, const std::error_code& error) {
  return {folder, "", "cannot be searched for scans: " + error.message(), "check its permissions"};
}

bool is_dataset(const fs::path& file) {
  return file.extension() == ".vtkhdf";
}

/// The kinds of files that are searched, and the folders that are not.
struct Search {
  bool datasets = false;  ///< Datasets are found as well as scans.
  std::vector<fs::path> passed_over;

  bool wants(const fs::path& file) const {
    return io::is_scan_name(file) || (datasets && is_dataset(file));
  }
  bool enters(const fs::path& folder) const {
    std::error_code ignored;
    return std::ranges::none_of(
        passed_over, [&](const fs::path& other) { return fs::equivalent(folder, other, ignored); });
  }
};

/// Appends the scans of a folder to `files` and its folders to `folders`. Returns why it cannot be
/// searched.
std::error_code list_folder(const fs::path& folder, const Search& search,
                            std::vector<fs::path>& files, std::vector<fs::path>& folders) {
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (is_hidden(entry->path())) continue;
    if (entry->is_directory(ignored)) {
      if (!entry->is_symlink(ignored) && search.enters(entry->path()))
        folders.push_back(entry->path());
    } else if (search.wants(entry->path())) {
      files.push_back(entry->path());
    }
  }
  return error;
}

void search_folder(const fs::path& top, const Search& search, std::vector<FoundScan>& found) {
  std::vector<fs::path> files;
  std::vector<fs::path> folders = {top};
  std::vector<FoundScan> unsearched;
  while (!folders.empty()) {
    const fs::path folder = std::move(folders.back());
    folders.pop_back();
    const std::error_code error = list_folder(folder, search, files, folders);
    if (!error) continue;
    if (folder == top) throw unsearchable(folder, error);
    unsearched.push_back(found_scan(folder, folder.lexically_relative(top)));
    unsearched.back().error = unsearchable(folder, error).what();
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    found.push_back(found_scan(file, file.lexically_relative(top)));
  std::ranges::sort(unsearched, {}, &FoundScan::input);
  std::ranges::move(unsearched, std::back_inserter(found));
}

void add_file(const fs::path& file, const Search& search, std::vector<FoundScan>& found) {
  if (!search.wants(file))
    throw io::Error(file, "", "is not a scan that semigeo reads",
                    "give " + io::scan_extensions(", ", " or ") + " files, also as .gz, " +
                        (search.datasets ? "datasets (.vtkhdf), " : "") + "or folders of them");
  found.push_back(found_scan(file, file.filename()));
}

std::vector<FoundScan> find(const std::vector<fs::path>& inputs, const Search& search) {
  std::vector<FoundScan> found;
  for (const fs::path& input : inputs) {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (!fs::exists(status)) throw io::Error(input, "", "no such file or folder", "check the path");
    if (fs::is_directory(status)) {
      search_folder(input, search, found);
    } else {
      add_file(input, search, found);
    }
  }

  std::set<fs::path> seen;
  std::erase_if(found, [&](const FoundScan& scan) { return !seen.insert(scan.file).second; });
  return found;
}

}  // namespace

std::vector<FoundScan> find_scans(const std::vector<fs::path>& inputs, const fs::path& archive) {
  return find(inputs, {.passed_over = {archive}});
}

std::vector<FoundScan> find_scenes(const std::vector<fs::path>& inputs,
                                   const std::vector<fs::path>& passed_over) {
  return find(inputs, {.datasets = true, .passed_over = passed_over});
}

}  // namespace semigeo::jobs
