#include "jobs/kinds/leftovers.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <system_error>
#include <utility>

#include "io/dataset/xdmf.hpp"
#include "io/files/container.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/find_scans.hpp"
#include "jobs/archive/links.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/kinds/library_plan.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/kinds/triplets.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Returns whether a path is that of the folder or of something below it. Both are absolute.
bool is_in(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

bool is_in_any(const fs::path& path, const std::vector<fs::path>& folders) {
  return std::ranges::any_of(folders, [&](const fs::path& folder) { return is_in(path, folder); });
}

/// Returns whether the name is that of a file, so that nothing outside of the archive's own folders
/// is touched whatever sources.json says.
bool is_file_name(const std::string& name) {
  return !name.empty() && !name.starts_with('.') && fs::path(name).filename() == name;
}

/// Returns the leftover with those of the files that are there. Throws io::ReadError if that cannot
/// be known.
Leftover leftover_of(Leftover::Kind kind, const std::string& name, const fs::path& scan,
                     const std::vector<fs::path>& files) {
  Leftover leftover{.kind = kind, .name = name, .scan = scan, .files = {}};
  for (const fs::path& file : files) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(file, error);
    const bool known = fs::status_known(status) || error == std::errc::filename_too_long;
    if (!known) throw io::open_error(file, error.value());
    if (!fs::is_regular_file(status) && !fs::is_symlink(status)) continue;
    leftover.files.push_back(file);
    if (const auto bytes = fs::file_size(file, error); !error) leftover.bytes += bytes;
  }
  return leftover;
}

Leftover dataset_leftover(const fs::path& archive, const std::string& name, const fs::path& scan) {
  const fs::path dataset = dataset_path(archive, name);
  return leftover_of(
      Leftover::Kind::kDataset, name, scan,
      {dataset, io::sidecar_of(dataset), run_path(place_of_archive(archive).parts, name),
       archive / "logs" / (name + ".log"), archive / "logs" / (name + ".triplets.log")});
}

Leftover recognised_leftover(const fs::path& archive, const std::string& name,
                             const fs::path& scene) {
  return leftover_of(
      Leftover::Kind::kRecognised, name, scene,
      {recognised_path(archive, name), archive / "logs" / (name + ".recognise.log")});
}

/// Returns the folders that were named and those that symbolic links in them lead to, as absolute
/// paths without links.
std::vector<fs::path> resolved(const std::vector<fs::path>& folders) {
  std::vector<fs::path> result;
  for (const fs::path& folder : folders) {
    if (!io::is_folder(folder))
      throw io::Error(folder, "", "there is no such folder, so nothing is removed",
                      "see that its disk is mounted; if the folder itself was removed, name the "
                      "folder above it");
    std::error_code error;
    const fs::path path = fs::canonical(folder, error);
    if (error) throw io::open_error(folder, error.value());
    result.push_back(path);
    std::ranges::move(folders_behind_links(path), std::back_inserter(result));
  }
  return result;
}

/// Watches which folders have lost all of their scans.
class Losses {
 public:
  explicit Losses(const std::vector<fs::path>& folders) : folders_(folders) {}

  void add(const fs::path& scan, bool gone) {
    for (const fs::path& folder : folders_) {
      if (!is_in(scan, folder)) continue;
      Count& count = counts_[folder];
      ++(gone ? count.gone : count.left);
      if (!gone) continue;
      for (fs::path at = io::outer_file(scan).parent_path(); at != folder; at = at.parent_path())
        below_.insert(at);
    }
  }

  std::vector<fs::path> emptied() const {
    std::set<fs::path> result;
    for (const auto& [folder, count] : counts_)
      if (count.gone > 0 && count.left == 0) result.insert(folder);
    for (const fs::path& folder : below_) {
      std::error_code error;  // a folder that was removed is no place where a disk is missing
      if (fs::is_empty(folder, error) && !error) result.insert(folder);
    }
    return {result.begin(), result.end()};
  }

 private:
  struct Count {
    int gone = 0;
    int left = 0;
  };
  const std::vector<fs::path>& folders_;
  std::map<fs::path, Count> counts_;
  std::set<fs::path> below_;  ///< Folders from which scans are gone.
};

/// Returns whether the scan is gone. One about which nothing can be known is not.
bool has_gone(const fs::path& scan, std::vector<io::ReadError>& unknown) {
  try {
    return !io::is_there(io::outer_file(scan));
  } catch (const io::ReadError& error) {
    unknown.push_back(error);
    return false;
  }
}

/// Removes the files. Returns whether none is there any more.
bool remove_files(const Leftover& leftover, std::vector<io::Error>& failures) {
  const std::size_t before = failures.size();
  for (const fs::path& file : leftover.files) {
    std::error_code error;
    fs::remove(file, error);
    if (!error) continue;
    const bool forbidden = error == std::errc::permission_denied ||
                           error == std::errc::operation_not_permitted ||
                           error == std::errc::read_only_file_system;
    failures.emplace_back(
        file, "", "cannot be removed: " + error.message(),
        forbidden ? "check the permissions of the archive" : "check the disk of the archive");
  }
  return failures.size() == before;
}

/// The records of an archive.
struct Records {
  Sources scans;
  Sources scenes;
};

Records records_of(const fs::path& archive) {
  return {.scans = Sources::read(archive), .scenes = Sources::read(recognised_folder(archive))};
}

}  // namespace

std::vector<fs::path> recorded_folders(const fs::path& archive) {
  const Records records = records_of(archive);
  std::error_code ignored;
  const fs::path own = fs::weakly_canonical(archive, ignored);
  std::set<fs::path> all;
  for (const Sources* sources : {&records.scans, &records.scenes})
    for (const auto& [name, scan] : sources->by_name())
      if (!is_in(scan, own)) all.insert(io::outer_file(scan).parent_path());
  std::vector<fs::path> folders;
  for (const fs::path& folder : all)  // a folder stands before those below it
    if (!is_in_any(folder, folders)) folders.push_back(folder);
  return folders;
}

Leftovers find_leftovers(const fs::path& archive, const std::vector<fs::path>& folders,
                         const std::set<std::string>& in_use) {
  const std::vector<fs::path> named = resolved(folders);
  const Records records = records_of(archive);
  Losses losses(named);
  Leftovers found;
  std::set<fs::path> datasets;
  for (const auto& [name, scan] : records.scans.by_name()) {
    if (!is_in_any(scan, named) || !is_file_name(name)) continue;
    const bool gone = !in_use.contains(name) && has_gone(scan, found.unknown);
    losses.add(scan, gone);
    if (!gone) continue;
    Leftover leftover = dataset_leftover(archive, name, scan);
    std::error_code ignored;
    datasets.insert(fs::weakly_canonical(dataset_path(archive, name), ignored));
    (leftover.files.empty() ? found.recorded : found.list).push_back(std::move(leftover));
  }
  for (const auto& [name, scene] : records.scenes.by_name()) {
    const bool of_leftover = datasets.contains(scene);
    if (!(is_in_any(scene, named) || of_leftover) || !is_file_name(name)) continue;
    const bool gone = of_leftover || has_gone(scene, found.unknown);
    if (!of_leftover) losses.add(scene, gone);
    if (!gone) continue;
    Leftover leftover = recognised_leftover(archive, name, scene);
    (leftover.files.empty() ? found.recorded : found.list).push_back(std::move(leftover));
  }
  found.emptied = losses.emptied();
  if (!found.emptied.empty()) found.recorded.clear();
  if (found.list.empty()) found.emptied.clear();  // nothing would be removed
  return found;
}

Removal remove_leftovers(const fs::path& archive, const Leftovers& leftovers) {
  Removal removal;
  if (leftovers.list.empty() && leftovers.recorded.empty()) return removal;
  refuse_links(archive);
  Records records = records_of(archive);
  for (const Leftover& leftover : leftovers.list)
    (remove_files(leftover, removal.failures) ? removal.removed : removal.left).push_back(leftover);
  const auto forget = [&](const Leftover& leftover) {
    const bool is_dataset = leftover.kind == Leftover::Kind::kDataset;
    (is_dataset ? records.scans : records.scenes).forget(leftover.name);
  };
  std::ranges::for_each(removal.removed, forget);
  std::ranges::for_each(leftovers.recorded, forget);
  try {
    if (!records.scans.by_name().empty() || fs::exists(archive / "sources.json"))
      records.scans.write(archive);
    if (fs::exists(recognised_folder(archive))) records.scenes.write(recognised_folder(archive));
  } catch (const io::Error& error) {
    removal.failures.push_back(error);
  }
  return removal;
}

}  // namespace semigeo::jobs
