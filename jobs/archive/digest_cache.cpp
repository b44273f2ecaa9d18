#include "jobs/archive/digest_cache.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <ctime>
#include <iterator>
#include <string_view>
#include <utility>

#include "engine/parallel.hpp"
#include "io/dataset/dataset.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/input_file.hpp"
#include "io/files/small_file.hpp"
#include "io/scans/companions.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "digests.txt";
constexpr std::int64_t kNanoseconds = 1'000'000'000;
/// The coarsest step of the times of file systems in use.
constexpr std::int64_t kRacy = 2 * kNanoseconds;
constexpr std::string_view kNoJob = "-";
constexpr std::string_view kCompanion = "+";  // in place of a digest

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * kNanoseconds + time.tv_nsec;
}

/// Returns the first line of the file. Files of other versions and damaged files begin otherwise.
std::string head_of(std::string_view body) {
  return "semigeo-digests 2 " + std::to_string(io::kDatasetFormatVersion) + ' ' +
         io::xxh3_of_text(body) + '\n';
}

/// Returns the text of the file. It is empty if the file cannot be read or is another: the digests
/// are then computed again.
std::string text_of(const fs::path& file) {
  constexpr io::TextBounds kBounds = {.bytes = std::int64_t{256} << 20};
  const std::string begin = head_of("").substr(0, head_of("").rfind(' '));
  try {
    std::string start(begin.size(), '\0');
    if (io::InputFile(file).read_at(0, start) == start.size() && start == begin)
      return io::read_text(file, kBounds);
  } catch (const io::Error&) {
  }
  return "";
}

/// Removes the text before the next space from the line and returns it.
std::string_view next_word(std::string_view& line) {
  const std::size_t end = std::min(line.find(' '), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  return word;
}

template <typename Number>
Number next_number(std::string_view& line) {
  const std::string_view word = next_word(line);
  Number number = 0;
  std::from_chars(word.data(), word.data() + word.size(), number);
  return number;
}

std::string line_of(const DatasetKeys& keys, const FileStamp& stamp, const std::string& path) {
  return keys.input_xxh3 + ' ' + keys.job_key + ' ' + std::to_string(stamp.size) + ' ' +
         std::to_string(stamp.modified) + ' ' + std::to_string(stamp.changed) + ' ' +
         std::to_string(stamp.inode) + ' ' + path + '\n';
}

bool is_scan(const std::string& path) {
  return path.starts_with('/');
}

/// Returns the file whose stamp tells whether a scan has changed.
const fs::path& file_to_stamp(const FoundScan& scan) {
  return scan.container.empty() ? scan.file : scan.container;
}

}  // namespace

std::optional<FileStamp> stamp_of(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{.size = status.st_size,
                   .modified = nanoseconds(status.st_mtim),
                   .changed = nanoseconds(status.st_ctim),
                   .inode = status.st_ino};
}

fs::path dataset_path(const fs::path& archive, const std::string& name) {
  return archive / "scans" / (name + ".vtkhdf");
}

/// The content that was read from a file, and its stamps before and after.
struct DigestCache::Reading {
  DatasetKeys keys;
  std::int64_t begun = 0;
  std::optional<FileStamp> before;
  std::optional<FileStamp> after;
  std::vector<Companion> companions = {};
  bool companions_changed = false;

  bool is_old(const FileStamp& stamp) const {
    return std::max(stamp.modified, stamp.changed) + kRacy <= begun;
  }
  bool is_trustworthy() const {
    return before && before == after && is_old(*before) && !companions_changed &&
           std::ranges::all_of(companions, [&](const Companion& c) { return is_old(c.stamp); });
  }
};

std::int64_t DigestCache::system_clock() {
  timespec time{};
  clock_gettime(CLOCK_REALTIME, &time);
  return nanoseconds(time);
}

DigestCache::DigestCache(fs::path archive, Clock clock)
    : archive_(std::move(archive)), now_(clock) {}

DigestCache DigestCache::read(const fs::path& archive, Clock clock) {
  DigestCache cache(archive, clock);
  std::string text = text_of(archive / kFileName);
  const std::size_t head_end = text.find('\n');
  if (head_end == std::string::npos) return cache;
  std::string_view body = std::string_view(text).substr(head_end + 1);
  if (!text.starts_with(head_of(body))) return cache;
  while (!body.empty()) {
    std::string_view line = body.substr(0, body.find('\n'));
    body.remove_prefix(std::min(line.size() + 1, body.size()));
    Entry entry;
    entry.keys.input_xxh3 = next_word(line);
    entry.keys.job_key = next_word(line);
    entry.stamp.size = next_number<std::int64_t>(line);
    entry.stamp.modified = next_number<std::int64_t>(line);
    entry.stamp.changed = next_number<std::int64_t>(line);
    entry.stamp.inode = next_number<std::uint64_t>(line);
    if (entry.keys.input_xxh3 == kCompanion && !cache.entries_.empty()) {
      std::prev(cache.entries_.end())
          ->second.companions.push_back({.path = std::string(line), .stamp = entry.stamp});
    } else {
      cache.entries_.emplace_hint(cache.entries_.end(), line, std::move(entry));
    }
  }
  cache.text_ = std::move(text);
  return cache;
}

const DigestCache::Entry* DigestCache::find(const std::string& path,
                                            const std::optional<FileStamp>& stamp) const {
  const auto found = entries_.find(path);
  if (found == entries_.end() || found->second.stamp != stamp) return nullptr;
  const bool same = std::ranges::all_of(found->second.companions, [](const Companion& companion) {
    return stamp_of(companion.path).value_or(FileStamp()) == companion.stamp;
  });
  return same ? &found->second : nullptr;
}

void DigestCache::remember(const std::string& path, const Reading& reading) {
  // A line ends with its path. Paths with line ends are not remembered.
  const bool has_line_end = path.find('\n') != std::string::npos ||
                            std::ranges::any_of(reading.companions, [](const Companion& companion) {
                              return companion.path.find('\n') != std::string::npos;
                            });
  if (reading.is_trustworthy() && !has_line_end) {
    entries_[path] = {.keys = reading.keys,
                      .stamp = *reading.before,
                      .companions = reading.companions,
                      .used = true};
  } else {
    entries_.erase(path);
  }
}

void DigestCache::digest_members(const std::vector<FoundScan>& scans, int threads,
                                 std::vector<Reading>& readings,
                                 std::vector<ScanDigest>& digests) const {
  std::map<fs::path, std::vector<std::size_t>> by_container;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (scans[i].container.empty() || !scans[i].error.empty()) continue;
    if (const Entry* known = begin(scans[i], readings[i])) {
      digests[i].xxh3 = known->keys.input_xxh3;
    } else {
      by_container[scans[i].container].push_back(i);
    }
  }
  std::vector<WantedMembers> wanted;
  for (const auto& [container, members] : by_container) {
    wanted.push_back({.container = container, .names = {}});
    for (const std::size_t i : members)
      wanted.back().names.push_back(scans[i].input.lexically_relative(container).native());
  }
  const auto found = digests_of_members(wanted, threads);
  auto of_container = found.begin();
  for (const auto& [container, members] : by_container) {
    for (const std::size_t i : members) {
      digests[i] = of_container->at(scans[i].input.lexically_relative(container).native());
      // The size of companions is not remembered, so scans with companions are not, either.
      if (digests[i].error.empty() && digests[i].companions.empty())
        end(scans[i], digests[i], readings[i]);
    }
    ++of_container;
  }
}

std::vector<ScanDigest> DigestCache::scan_digests(const std::vector<FoundScan>& scans,
                                                  int threads) {
  std::vector<Reading> readings(scans.size());
  std::vector<ScanDigest> digests(scans.size());
  digest_members(scans, threads, readings, digests);
  const auto digest = [&](std::size_t i) {
    if (const Entry* known = begin(scans[i], readings[i])) {
      digests[i].xxh3 = known->keys.input_xxh3;
      return;
    }
    try {
      digests[i] = digest_file(scans[i], readings[i]);
    } catch (const std::exception& e) {
      digests[i].error = e.what();
    }
  };
  const auto count = static_cast<std::int64_t>(scans.size());
  engine::Workers(threads).for_blocks(count, 1, [&](engine::IndexRange range) {
    const auto i = static_cast<std::size_t>(range.begin);
    if (!scans[i].error.empty()) {
      digests[i].error = scans[i].error;
    } else if (scans[i].container.empty()) {
      digest(i);
    }
  });
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::string& path = scans[i].file.native();
    if (find(path, readings[i].before) != nullptr) {
      entries_[path].used = true;
    } else {
      remember(path, readings[i]);
    }
  }
  return digests;
}

const DigestCache::Entry* DigestCache::begin(const FoundScan& scan, Reading& reading) const {
  reading.begun = now_();
  reading.before = stamp_of(file_to_stamp(scan));
  return find(scan.file.native(), reading.before);
}

void DigestCache::end(const FoundScan& scan, const ScanDigest& digest, Reading& reading) {
  reading.keys = {.job_key = std::string(kNoJob), .input_xxh3 = digest.xxh3};
  reading.after = stamp_of(file_to_stamp(scan));
}

ScanDigest DigestCache::digest_file(const FoundScan& scan, Reading& reading) {
  io::ScanContent content = io::scan_content(scan.input);
  const auto stamp = [](const fs::path& file) { return stamp_of(file).value_or(FileStamp()); };
  std::vector<std::string> others;
  for (const fs::path& companion : content.companions) {
    reading.companions.push_back({.path = fs::absolute(companion), .stamp = stamp(companion)});
    others.push_back(io::xxh3_of_companion(scan.input, companion));
    reading.companions_changed |= stamp(companion) != reading.companions.back().stamp;
  }
  ScanDigest digest{.xxh3 = io::xxh3_with_companions(content.xxh3, others),
                    .error = "",
                    .companions = std::move(content.companions)};
  end(scan, digest, reading);
  return digest;
}

std::optional<DatasetKeys> DigestCache::dataset_keys(const std::string& name) {
  Reading reading;
  reading.begun = now_();
  const fs::path path = dataset_path(archive_, name);
  reading.before = stamp_of(path);
  if (find(name, reading.before) != nullptr) {
    Entry& entry = entries_[name];
    entry.used = true;
    return entry.keys;
  }
  std::optional<DatasetKeys> keys;
  try {
    io::DatasetOrigin origin = io::read_origin(path);
    keys = {.job_key = std::move(origin.job_key), .input_xxh3 = std::move(origin.input_xxh3)};
    reading.keys = *keys;
    reading.after = stamp_of(path);
  } catch (const io::Error&) {
  }
  remember(name, reading);
  return keys;
}

fs::path DigestCache::file_of(const std::string& path) const {
  if (!is_scan(path)) return dataset_path(archive_, path);
  return io::outer_file(path);
}

void DigestCache::write() {
  std::string body;
  for (const auto& [path, entry] : entries_) {
    // Entries that were not used are kept as long as their files exist. They belong to scans in
    // other folders.
    if (!entry.used && !stamp_of(file_of(path))) continue;
    body += line_of(entry.keys, entry.stamp, path);
    for (const Companion& companion : entry.companions)
      body += line_of({.job_key = std::string(kNoJob), .input_xxh3 = std::string(kCompanion)},
                      companion.stamp, companion.path);
  }
  std::string text = head_of(body) + body;
  if (text == text_) return;
  io::write_file_atomically(archive_ / kFileName, text);
  text_ = std::move(text);
}

}  // namespace semigeo::jobs
