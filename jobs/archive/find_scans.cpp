#include "jobs/archive/find_scans.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <functional>
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
constexpr const char* kOtherKind = "other";

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

/// Returns the kind of a file that is no scan.
std::string kind_of(const fs::path& file) {
  constexpr std::size_t kLongest = 9;
  std::string extension = file.extension().string();
  if (extension.size() < 2 || extension.size() > kLongest) return kOtherKind;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool plain = std::all_of(extension.begin() + 1, extension.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0;
  });
  return plain ? extension : kOtherKind;
}

/// The device and the inode of a folder, which are the same for every path to it.
using FolderId = std::pair<dev_t, ino_t>;

FolderId id_of(const fs::path& folder) {
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

/// Searches inputs for scans.
class Search {
 public:
  /// `datasets` are found as well as scans if asked for. Folders in `passed_over` are not searched.
  Search(bool datasets, std::vector<fs::path> passed_over)
      : datasets_(datasets), passed_over_(std::move(passed_over)) {}

  void add_input(const fs::path& input) {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (!fs::exists(status)) throw io::Error(input, "", "no such file or folder", "check the path");
    if (fs::is_directory(status)) {
      search_folder(input);
    } else {
      add_file(input);
    }
  }

  FoundScans found() && {
    std::set<fs::path> seen;
    std::erase_if(found_.scans,
                  [&](const FoundScan& scan) { return !seen.insert(scan.file).second; });
    return std::move(found_);
  }

 private:
  /// The state of the search of one input.
  struct Folder {
    fs::path top;
    std::vector<fs::path> files;
    std::vector<fs::path> folders;  // to be searched, without links
    std::set<fs::path> links;       // to folders
    std::set<FolderId> searched;
    std::vector<FoundScan> unsearched;
  };

  bool wants(const fs::path& file) const {
    return io::is_scan_name(file) || (datasets_ && is_dataset(file));
  }
  bool enters(const fs::path& folder) const {
    std::error_code ignored;
    return std::ranges::none_of(passed_over_, [&](const fs::path& other) {
      return fs::equivalent(folder, other, ignored);
    });
  }

  void add_file(const fs::path& file) {
    if (!wants(file))
      throw io::Error(file, "", "is not a scan that semigeo reads",
                      "give " + io::scan_extensions(", ", " or ") + " files, also as .gz, " +
                          (datasets_ ? "datasets (.vtkhdf), " : "") + "or folders of them");
    found_.scans.push_back(found_scan(file, file.filename()));
  }

  void add_entry(Folder& search, const fs::directory_entry& entry, bool counts) {
    std::error_code ignored;
    if (entry.is_directory(ignored)) {
      if (!enters(entry.path())) return;
      if (entry.is_symlink(ignored)) {
        search.links.insert(entry.path());
      } else {
        search.folders.push_back(entry.path());
      }
    } else if (wants(entry.path())) {
      search.files.push_back(entry.path());
    } else if (counts) {
      ++found_.passed_over.files[kind_of(entry.path())];
    }
  }

  /// Adds what is in a folder, unless it was searched before.
  void list_folder(Folder& search, const fs::path& folder) {
    const FolderId id = id_of(folder);
    if (!search.searched.insert(id).second) return;
    const bool counts = counted_.insert(id).second;  // not if another input was or held the folder
    std::error_code error;
    std::vector<fs::directory_entry> entries;
    fs::directory_iterator entry(folder, error);
    for (const fs::directory_iterator end; !error && entry != end; entry.increment(error))
      if (!is_hidden(entry->path())) entries.push_back(*entry);
    std::ranges::sort(entries);
    for (const fs::directory_entry& each : entries) add_entry(search, each, counts);
    if (!error) return;
    if (folder == search.top) throw unsearchable(folder, error);
    search.unsearched.push_back(found_scan(folder, folder.lexically_relative(search.top)));
    search.unsearched.back().error = unsearchable(folder, error).what();
  }

  void search_folder(const fs::path& top) {
    Folder search;
    search.top = top;
    search.folders = {top};
    while (!search.folders.empty() || !search.links.empty()) {
      if (search.folders.empty())
        search.folders.push_back(search.links.extract(search.links.begin()).value());
      const fs::path folder = std::move(search.folders.back());
      search.folders.pop_back();
      list_folder(search, folder);
    }
    std::ranges::sort(search.files);
    for (const fs::path& file : search.files)
      found_.scans.push_back(found_scan(file, file.lexically_relative(top)));
    std::ranges::sort(search.unsearched, {}, &FoundScan::input);
    std::ranges::move(search.unsearched, std::back_inserter(found_.scans));
  }

  bool datasets_;
  std::vector<fs::path> passed_over_;
  std::set<FolderId> counted_;
  FoundScans found_;
};

FoundScans find(const std::vector<fs::path>& inputs, Search search) {
  for (const fs::path& input : inputs) search.add_input(input);
  return std::move(search).found();
}

}  // namespace

std::string in_words(const PassedOver& passed_over) {
  constexpr std::size_t kMostKinds = 20;
  std::vector<std::pair<std::string, std::int64_t>> kinds;
  std::int64_t others = 0;
  for (const auto& [kind, count] : passed_over.files) {
    if (kind == kOtherKind) {
      others += count;
    } else {
      kinds.emplace_back(kind, count);
    }
  }
  std::ranges::stable_sort(kinds, std::ranges::greater{},
                           [](const auto& kind) { return kind.second; });
  for (; kinds.size() > kMostKinds; kinds.pop_back()) others += kinds.back().second;
  if (others > 0) kinds.emplace_back(kOtherKind, others);
  std::string text;
  for (const auto& [kind, count] : kinds)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + ' ' + kind;
  return text;
}

FoundScans find_scans(const std::vector<fs::path>& inputs, const fs::path& archive) {
  return find(inputs, Search(false, {archive}));
}

FoundScans find_scenes(const std::vector<fs::path>& inputs,
                       const std::vector<fs::path>& passed_over) {
  return find(inputs, Search(true, passed_over));
}

}  // namespace semigeo::jobs
