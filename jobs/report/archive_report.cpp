#include "jobs/report/archive_report.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "jobs/archive/dataset_files.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/archive/status.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSurface = "surface ";

/// The last word of the journal about the job that makes a dataset.
struct SurfaceHistory {
  std::map<std::string, JobEnded> last;  ///< The last end, by name of the dataset.
  std::map<std::string, JobEnded> made;  ///< The last end with a dataset.
};

SurfaceHistory read_history(const fs::path& archive) {
  SurfaceHistory history;
  const auto note = [&](const JournalEntry& entry) {
    const auto* job = std::get_if<JobEnded>(&entry.event);
    if (job == nullptr || !job->job.starts_with(kSurface)) return;
    const std::string name = job->job.substr(kSurface.size());
    history.last[name] = *job;
    if (job->state == "done") history.made[name] = *job;
  };
  read_journal(archive, note, std::numeric_limits<std::int64_t>::max());  // whole, for old scans
  return history;
}

/// Adds a sentence such as "a.ply: line 4: has no number; mend it" as reason and remedy.
void add_reason(nlohmann::json& record, const std::string& sentence) {
  constexpr std::string_view kBeforeRemedy = "; ";
  const std::size_t end = sentence.rfind(kBeforeRemedy);
  record["reason"] = sentence.substr(0, end);
  if (end != std::string::npos) record["remedy"] = sentence.substr(end + kBeforeRemedy.size());
}

nlohmann::json without_zeros(const nlohmann::json& counts) {
  nlohmann::json result = nlohmann::json::object();
  for (const auto& [name, count] : counts.items())
    if (count != 0) result[name] = count;
  return result;
}

/// Adds what the dataset of a scan says. Throws io::Error if it cannot be read.
void add_dataset(nlohmann::json& record, const fs::path& path) {
  const io::Dataset dataset(path);
  const io::DatasetHeader& header = dataset.header();
  const io::LevelInfo first = dataset.level(0);
  const std::int64_t level = dataset.selection().level;
  record["title"] = header.input_name;
  record["unit"] = header.length_unit;
  record["vertices"] = first.vertices;
  record["triangles"] = first.triangles;
  record["parts"] = first.parts;
  record["repairs"] = without_zeros(header.repairs);
  record["levels"] = dataset.level_count();
  record["level"] = level;
  record["features"] = dataset.level(static_cast<int>(level)).features.total();
  record["dataset_bytes"] = fs::file_size(path);
}

class ReportReader {
 public:
  explicit ReportReader(const fs::path& archive)
      : archive_(archive),
        status_(status_of(archive)),
        history_(read_history(archive)),
        sources_(Sources::read(archive)) {}

  nlohmann::json read() {
    const std::vector<fs::path> datasets = dataset_files(archive_ / "scans");
    std::map<std::string, fs::path> names;
    for (const fs::path& path : datasets) names[path.stem().string()] = path;
    for (const auto& [name, source] : sources_.by_name()) names.try_emplace(name);
    for (const auto& [job, error] : status_.failed)
      if (job.starts_with(kSurface)) names.try_emplace(job.substr(kSurface.size()));
    if (names.empty() && !status_.last_run)
      throw io::Error(archive_, "", "is no archive: it has no datasets and no journal",
                      "give the folder that was --output of a run");
    for (const auto& [name, path] : names) scans_.push_back(scan(name, path));
    std::ranges::stable_sort(scans_, {}, [](const nlohmann::json& s) { return order_of(s); });
    return {{"archive", fs::weakly_canonical(archive_).filename().string()},
            {"run", run()},
            {"failures", failures()},
            {"scans", scans_}};
  }

 private:
  static std::size_t order_of(const nlohmann::json& scan) {
    constexpr std::array<std::string_view, 6> kOrder = {"failed",  "damaged", "skipped",
                                                        "missing", "running", "done"};
    return std::ranges::find(kOrder, scan["state"].get<std::string>()) - kOrder.begin();
  }

  nlohmann::json run() const {
    nlohmann::json run = {{"state", state_of(status_)}};
    if (!status_.last_run) return run;
    run["started"] = status_.started;
    run["seconds"] = status_.seconds;
    run["vertex_levels_per_second"] = status_.vertex_levels_per_second();
    return run;
  }

  nlohmann::json scan(const std::string& name, const fs::path& dataset) const {
    nlohmann::json record = {{"name", name}, {"title", title_of(name)}};
    if (const auto made = history_.made.find(name); made != history_.made.end()) {
      record["seconds"] = made->second.seconds;
      record["peak_bytes"] = made->second.peak_bytes;
    }
    try {
      if (!dataset.empty()) add_dataset(record, dataset);
    } catch (const io::Error& e) {
      record["state"] = "damaged";
      add_reason(record, e.what());
      return record;
    }
    add_state(record, name, !dataset.empty());
    return record;
  }

  /// Returns the file name of a scan, or the name of its dataset if the archive does not know it.
  std::string title_of(const std::string& name) const {
    const auto source = sources_.by_name().find(name);
    if (source == sources_.by_name().end()) return name;
    return escaped(source->second.filename().string());
  }

  void add_state(nlohmann::json& record, const std::string& name, bool has_dataset) const {
    const auto last = history_.last.find(name);
    const std::string ended = last == history_.last.end() ? "" : last->second.state;
    if (status_.is_running() && status_.running.contains(std::string(kSurface) + name)) {
      record["state"] = "running";
    } else if (ended == "failed" || (ended == "skipped" && !has_dataset)) {
      record["state"] = ended;
      add_reason(record, last->second.error);
    } else {
      record["state"] = has_dataset ? "done" : "missing";
    }
  }

  /// Returns the failures of scans, and of the other jobs of the last run.
  nlohmann::json failures() const {
    nlohmann::json list = nlohmann::json::array();
    for (const nlohmann::json& scan : scans_) {
      if (scan["state"] != "failed" && scan["state"] != "damaged") continue;
      nlohmann::json failure = {{"job", scan["title"]}, {"reason", scan["reason"]}};
      if (scan.contains("remedy")) failure["remedy"] = scan["remedy"];
      list.push_back(std::move(failure));
    }
    for (const auto& [job, error] : status_.failed) {
      if (job.starts_with(kSurface)) continue;
      nlohmann::json failure = {{"job", job}};
      add_reason(failure, error);
      list.push_back(std::move(failure));
    }
    return list;
  }

  fs::path archive_;
  ArchiveStatus status_;
  SurfaceHistory history_;
  Sources sources_;
  std::vector<nlohmann::json> scans_;
};

}  // namespace

nlohmann::json archive_report(const fs::path& archive) {
  return ReportReader(archive).read();
}

}  // namespace semigeo::jobs
