#include "jobs/archive/journal.hpp"

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/input_file.hpp"
#include "io/files/json_value.hpp"
#include "io/files/read_error.hpp"
#include "jobs/archive/utc_time.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kBegin = "{\"crc\":\"";
constexpr std::string_view kAfterChecksum = "\",";
constexpr std::size_t kChecksumDigits = 8;
constexpr std::size_t kLongestError = 4096;
constexpr std::size_t kLongestLine = std::size_t{1} << 16;  // no version writes longer lines

std::string checksum(std::string_view text) {
  return io::xxh3_of_text(text).substr(0, kChecksumDigits);
}

/// Visits the fields of an event in the order in which they are written, for writing and reading.
template <typename Visit>
void for_each_field(RunStarted& event, const Visit& visit) {
  visit("version", event.version);
  visit("host", event.host);
  visit("pid", event.pid);
  visit("threads", event.threads);
  visit("jobs", event.jobs);
  visit("up_to_date", event.up_to_date);
  visit("input_bytes", event.input_bytes);
  visit("passed_over", event.passed_over);
}

template <typename Visit>
void for_each_field(JobStarted& event, const Visit& visit) {
  visit("job", event.job);
  visit("key", event.key);
}

template <typename Visit>
void for_each_field(JobEnded& event, const Visit& visit) {
  visit("job", event.job);
  visit("key", event.key);
  visit("state", event.state);
  visit("error", event.error);
  visit("format", event.format);
  visit("notes", event.notes);
  visit("seconds", event.seconds);
  visit("cpu_seconds", event.cpu_seconds);
  visit("peak_bytes", event.peak_bytes);
  visit("vertices", event.vertices);
  visit("levels", event.levels);
  visit("input_bytes", event.input_bytes);
  visit("threads", event.threads);
}

template <typename Visit>
void for_each_field(RunEnded& event, const Visit& visit) {
  visit("done", event.done);
  visit("up_to_date", event.up_to_date);
  visit("failed", event.failed);
  visit("seconds", event.seconds);
  visit("cpu_seconds", event.cpu_seconds);
}

const char* name_of(const RunStarted&) {
  return "run_started";
}
const char* name_of(const JobStarted&) {
  return "started";
}
const char* name_of(const JobEnded&) {
  return "ended";
}
const char* name_of(const RunEnded&) {
  return "run_ended";
}

std::string line_of(JournalEntry entry) {
  Json document;
  std::visit(
      [&](auto& event) {
        document["event"] = name_of(event);
        for_each_field(event, [&](const char* name, auto& value) { document[name] = value; });
      },
      entry.event);
  document["time"] = entry.time;
  document["run"] = entry.run;
  // Names of files need not be UTF-8, but JSON must.
  const std::string object = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string rest = object.substr(1);
  return std::string(kBegin) + checksum(rest) + std::string(kAfterChecksum) + rest + '\n';
}

bool is_whole(std::string_view line) {
  constexpr std::size_t kRest = kBegin.size() + kChecksumDigits + kAfterChecksum.size();
  return line.size() > kRest && line.starts_with(kBegin) &&
         line.substr(kBegin.size() + kChecksumDigits).starts_with(kAfterChecksum) &&
         line.substr(kBegin.size(), kChecksumDigits) == checksum(line.substr(kRest));
}

/// Reads an event if the document is one of its kind.
template <typename Event>
void read_event(const Json& document, std::optional<JournalEvent>& found) {
  Event event;
  if (document.at("event") != name_of(event)) return;
  for_each_field(event, [&](const char* name, auto& value) {
    if (document.contains(name)) io::read_value(document.at(name), value);
  });
  found = std::move(event);
}

/// Returns whether the line is whole. Calls `visit` with its entry if the event is known.
bool read_line(std::string_view line, const std::function<void(const JournalEntry&)>& visit) {
  if (line.empty()) return true;  // a torn line that was ended twice
  if (!is_whole(line)) return false;
  std::optional<JournalEvent> event;
  JournalEntry entry;
  try {
    const Json document = Json::parse(line);
    read_event<RunStarted>(document, event);
    read_event<JobStarted>(document, event);
    read_event<JobEnded>(document, event);
    read_event<RunEnded>(document, event);
    document.at("time").get_to(entry.time);
    document.at("run").get_to(entry.run);
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  if (!event) return true;
  entry.event = *std::move(event);
  visit(entry);
  return true;
}

[[noreturn]] void fail(const fs::path& path, const char* action, int error) {
  throw io::Error(path, "", action + std::generic_category().message(error),
                  "check its permissions and the free space");
}

bool lacks_end(const engine::Descriptor& file) {
  const off_t size = lseek(file.get(), 0, SEEK_END);
  char last = '\n';
  return size > 0 && pread(file.get(), &last, 1, size - 1) == 1 && last != '\n';
}

}  // namespace

Journal::Journal(const fs::path& archive, std::string run)
    : path_(archive / kJournalName),
      run_(std::move(run)),
      file_(engine::open_file(path_, O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK)),
      torn_(file_ && lacks_end(file_)) {
  if (!file_ && errno == ELOOP)
    throw io::Error(path_, "", "is a symbolic link, which is not followed for writing",
                    "put the file itself in its place");
  if (!file_) fail(path_, "cannot be opened: ", errno);
}

void Journal::write(const JournalEvent& event) {
  JournalEntry entry{event, utc_time(), run_};
  if (auto* ended = std::get_if<JobEnded>(&entry.event))
    if (ended->error.size() > kLongestError) ended->error.resize(kLongestError);
  const std::string text = (torn_ ? "\n" : "") + line_of(std::move(entry));
  ssize_t written = 0;
  do {
    written = ::write(file_.get(), text.data(), text.size());
  } while (written < 0 && errno == EINTR);
  if (written < 0) fail(path_, "cannot be written: ", errno);
  torn_ = written < static_cast<ssize_t>(text.size());
  if (torn_) fail(path_, "cannot be written: ", ENOSPC);
}

std::int64_t read_journal(const fs::path& archive,
                          const std::function<void(const JournalEntry&)>& visit,
                          std::int64_t most_bytes) {
  const fs::path path = archive / kJournalName;
  if (!io::is_there(path)) return 0;
  const io::InputFile file(path);
  const auto size = static_cast<std::uint64_t>(file.size());
  // Begins a byte early: if that byte ends a line, the line after it is whole.
  std::uint64_t at =
      file.size() > most_bytes ? size - static_cast<std::uint64_t>(most_bytes) - 1 : 0;
  bool skipping = file.size() > most_bytes;  // the rest of a line whose beginning is not read
  std::vector<char> buffer(kLongestLine);
  std::string line;
  bool too_long = false;
  std::int64_t damaged = 0;
  const auto end_line = [&] {
    if (!std::exchange(skipping, false) && (too_long || !read_line(line, visit))) ++damaged;
    line.clear();
    too_long = false;
  };
  // What is appended meanwhile is left to the next reader, so that this one ends.
  while (at < size) {
    const std::size_t got = file.read_at(
        at, std::span(buffer).first(std::min<std::uint64_t>(buffer.size(), size - at)));
    if (got == 0) break;
    at += got;
    std::string_view piece(buffer.data(), got);
    while (!piece.empty()) {
      const std::size_t end = piece.find('\n');
      const std::string_view part = piece.substr(0, end);
      too_long = too_long || line.size() + part.size() > kLongestLine;
      if (!too_long) line += part;
      if (end == std::string_view::npos) break;
      end_line();
      piece.remove_prefix(end + 1);
    }
  }
  // A last line without an end is torn, or is being written by another run.
  if (!line.empty() || too_long) end_line();
  return damaged;
}

}  // namespace semigeo::jobs
