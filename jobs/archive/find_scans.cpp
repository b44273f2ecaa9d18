#include "jobs/archive/find_scans.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "io/files/lower_case.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/companions.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/archive/containers.hpp"
#include "jobs/archive/names.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOtherKind = "other";

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
  extension = io::lower_case(extension);
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

/// Returns whether an error is that of a link to nothing.
bool leads_nowhere(const std::error_code& error) {
  return error == std::errc::no_such_file_or_directory || error == std::errc::not_a_directory ||
         error == std::errc::too_many_symbolic_link_levels;
}

/// Returns whether a member is `within`, or in the folder of this name; "" is the whole container.
bool is_within(const std::string& name, const std::string& within) {
  return within.empty() || name == within ||
         (name.starts_with(within) && name[within.size()] == '/');
}

FoundScan found_member(const FoundScan& container, const io::Member& member) {
  const fs::path relative = fs::path(container.relative) / member.name;
  FoundScan scan{.input = container.input / member.name,
                 .relative = relative.generic_string(),
                 .name = dataset_name(relative),
                 .file = container.file / member.name,
                 .error = "",
                 .container = container.input,
                 .bytes = static_cast<std::uintmax_t>(member.bytes)};
  if (member.encrypted)
    scan.error = io::Error(scan.input, "", "is encrypted",
                           "unpack the container with its password and give the scans")
                     .what();
  return scan;
}

/// Counts a member that is no scan.
void pass_over(const FoundScan& container, const io::Member& member, PassedOver& passed_over) {
  ++passed_over.files[kind_of(member.name)];
  if (io::is_container_name(member.name))
    passed_over.notes.push_back((container.input / member.name).string() +
                                ": a container in a container is not opened; unpack it");
}

/// Counts links, and says which members have the names of others.
void note(const FoundScan& container, const io::ContainerListing& listing,
          PassedOver& passed_over) {
  if (listing.links > 0) passed_over.files["links in containers"] += listing.links;
  if (listing.repeated > 0)
    passed_over.notes.push_back(
        container.input.string() + ": " + std::to_string(listing.repeated) +
        " members have the name of one before them; the first of each name is read");
}

/// Returns the files that a scan names. One that cannot be read has none; its job says why.
std::vector<fs::path> companions_of(const fs::path& scan) {
  try {
    return io::scan_content(scan).companions;
  } catch (const io::Error&) {
    return {};
  }
}

/// Returns the folders in a container whose files may belong to a scan: those with such a scan.
std::set<std::string> folders_with_companions(const io::ContainerListing& listing) {
  std::set<std::string> folders;
  for (const io::Member& member : listing.members)
    if (io::may_have_companions(member.name))
      folders.insert(fs::path(member.name).parent_path().string());
  return folders;
}

/// Returns whether a member looks like a part of a scan beside it. To be sure, the container would
/// have to be read.
bool is_part_of_scan(const std::string& member, const std::set<std::string>& folders) {
  return kind_of(member) == ".bin" && std::ranges::any_of(folders, [&](const std::string& folder) {
           return is_within(member, folder);
         });
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
    if (status.type() == fs::file_type::none) throw io::open_error(input, error.value());
    if (fs::is_directory(status)) {
      search_folder(input);
    } else if (fs::exists(status)) {
      add_file(input);
    } else if (const auto place = io::member_path(input)) {
      found_.push_back({found_scan(place->container, place->container.filename()), place->member});
    } else {
      throw io::Error(input, "", "no such file or folder", "check the path");
    }
  }

  FoundScans found() && {
    const std::map<fs::path, io::ContainerListing> listings = listings_of_containers();
    leave_out_companions();
    FoundScans result{.scans = {}, .passed_over = std::move(passed_over_files_)};
    std::set<fs::path> counted;
    for (Found& each : found_) {
      const auto listing = listings.find(each.scan.file);
      if (!each.within) {
        result.scans.push_back(std::move(each.scan));
      } else {
        add_members(each, listing->second, counted.insert(each.scan.file).second, result);
      }
    }
    std::set<fs::path> seen;
    std::erase_if(result.scans,
                  [&](const FoundScan& scan) { return !seen.insert(scan.file).second; });
    return result;
  }

 private:
  /// A scan, or a container if `within` is set: the folder or file in it that is wanted, or "".
  struct Found {
    FoundScan scan;
    std::optional<std::string> within;
  };

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
    return io::is_scan_name(file) || (datasets_ && is_dataset(file)) || io::is_container_name(file);
  }
  static Found found(const fs::path& file, const fs::path& relative) {
    return {found_scan(file, relative),
            io::is_container_name(file) ? std::optional("") : std::nullopt};
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
                          (datasets_ ? "datasets (.vtkhdf), " : "") +
                          "or folders or containers (.zip, .7z, .tar) of them");
    found_.push_back(found(file, file.filename()));
  }

  void add_entry(Folder& search, const fs::directory_entry& entry, bool counts) {
    std::error_code error;
    std::error_code ignored;
    if (entry.is_directory(error)) {
      if (!enters(entry.path())) return;
      if (entry.is_symlink(ignored)) {
        search.links.insert(entry.path());
      } else {
        search.folders.push_back(entry.path());
      }
    } else if (wants(entry.path())) {
      search.files.push_back(entry.path());
    } else if (error && !leads_nowhere(error)) {
      add_unsearched(search, entry.path(), error);  // it may be a folder
    } else if (counts) {
      ++passed_over_files_.files[kind_of(entry.path())];
    }
  }

  /// Adds what is in a folder, unless it was searched before.
  void list_folder(Folder& search, const fs::path& folder) {
    const FolderId id = id_of(folder);
    if (id != FolderId() && !search.searched.insert(id).second) return;
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
    add_unsearched(search, folder, error);
  }

  static void add_unsearched(Folder& search, const fs::path& folder, const std::error_code& error) {
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
      found_.push_back(found(file, file.lexically_relative(top)));
    std::ranges::sort(search.unsearched, {}, &FoundScan::input);
    for (FoundScan& folder : search.unsearched) found_.push_back({std::move(folder), std::nullopt});
  }

  /// Corrects the numbers of files that were passed over: files that belong to a scan were not.
  void leave_out_companions() {
    std::set<fs::path> known;
    for (const Found& each : found_) {
      if (passed_over_files_.files.empty()) return;
      if (each.within || !each.scan.error.empty() || !io::may_have_companions(each.scan.input))
        continue;
      for (const fs::path& companion : companions_of(each.scan.input))
        if (was_passed_over(companion) && known.insert(identity(companion)).second)
          passed_over_files_.forget(kind_of(companion));
    }
  }

  /// Returns whether a file was counted.
  bool was_passed_over(const fs::path& file) const {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored) && !is_hidden(file) && !wants(file) &&
           counted_.contains(id_of(file.parent_path()));
  }

  /// Lists each container once. The key is its identity.
  std::map<fs::path, io::ContainerListing> listings_of_containers() const {
    std::map<fs::path, io::ContainerListing> listings;
    std::vector<fs::path> containers;
    std::vector<fs::path> keys;
    for (const Found& each : found_) {
      if (!each.within || !listings.try_emplace(each.scan.file).second) continue;
      containers.push_back(each.scan.input);
      keys.push_back(each.scan.file);
    }
    std::vector<io::ContainerListing> listed = list_containers(containers);
    for (std::size_t i = 0; i < keys.size(); ++i) listings[keys[i]] = std::move(listed[i]);
    return listings;
  }

  /// Adds the scans that are wanted of a container, in the order of their names.
  static void add_members(const Found& container, const io::ContainerListing& listing, bool counts,
                          FoundScans& result) {
    std::vector<FoundScan> scans;
    const std::set<std::string> folders = folders_with_companions(listing);
    for (const io::Member& member : listing.members) {
      if (is_hidden_member(member.name) || !is_within(member.name, *container.within)) continue;
      if (io::is_scan_name(member.name)) {
        scans.push_back(found_member(container.scan, member));
      } else if (counts && !is_part_of_scan(member.name, folders)) {
        pass_over(container.scan, member, result.passed_over);
      }
    }
    if (counts) note(container.scan, listing, result.passed_over);
    const bool missing = scans.empty() && listing.error.empty() && !container.within->empty();
    if (missing)
      throw io::Error(container.scan.input / *container.within, "",
                      "the container has no scan of this name and no folder with scans",
                      "list what it has: semigeo info " + container.scan.input.string());
    std::ranges::sort(scans, {}, &FoundScan::input);
    std::ranges::move(scans, std::back_inserter(result.scans));
    if (listing.error.empty()) return;
    result.scans.push_back(container.scan);
    result.scans.back().error = listing.error;
  }

  bool datasets_;
  std::vector<fs::path> passed_over_;
  std::set<FolderId> counted_;
  std::vector<Found> found_;
  PassedOver passed_over_files_;
};

FoundScans find(const std::vector<fs::path>& inputs, Search search) {
  for (const fs::path& input : inputs) search.add_input(input);
  return std::move(search).found();
}

}  // namespace

void PassedOver::forget(const std::string& kind) {
  const auto count = files.find(kind);
  if (count != files.end() && --count->second == 0) files.erase(count);
}

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

std::vector<fs::path> folders_behind_links(const fs::path& folder) {
  std::vector<fs::path> found;
  std::set<FolderId> searched;
  for (std::vector<fs::path> waiting = {folder}; !waiting.empty();) {
    const fs::path next = std::move(waiting.back());
    waiting.pop_back();
    if (!searched.insert(id_of(next)).second) continue;
    std::error_code error;
    fs::directory_iterator entry(next, error);
    for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
      std::error_code ignored;
      if (is_hidden(entry->path()) || !entry->is_directory(ignored)) continue;
      waiting.push_back(entry->path());
      if (entry->is_symlink(ignored)) found.push_back(identity(entry->path()));
    }
  }
  std::ranges::sort(found);
  return found;
}

FoundScans find_scans(const std::vector<fs::path>& inputs, const fs::path& archive) {
  return find(inputs, Search(false, {archive}));
}

FoundScans find_scenes(const std::vector<fs::path>& inputs,
                       const std::vector<fs::path>& passed_over) {
  return find(inputs, Search(true, passed_over));
}

}  // namespace semigeo::jobs
