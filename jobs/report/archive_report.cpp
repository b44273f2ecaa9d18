#include "jobs/report/archive_report.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/base64.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/input_file.hpp"
#include "io/files/read_error.hpp"
#include "jobs/archive/dataset_files.hpp"
#include "jobs/archive/in_children.hpp"
#include "jobs/archive/journal.hpp"
#include "jobs/archive/names.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/archive/status.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/report_files.hpp"
#include "jobs/report/run_figures.hpp"
#include "jobs/report/run_history.hpp"
#include "jobs/report/thumbnail.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSurface = "surface ";

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

/// Returns what the dataset of a scan says, and its thumbnail, which is drawn unless its page has
/// it. Throws io::Error if the dataset cannot be read.
nlohmann::json record_of(const fs::path& path, const std::string& icon) {
  nlohmann::json record;
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
  record["dataset_bytes"] = io::InputFile(path).size();
  const auto drawn = [&] {
    const std::string png = thumbnail_of(dataset);
    return io::base64(std::as_bytes(std::span(png)));
  };
  record["thumbnail"] = icon.empty() ? drawn() : icon;
  return record;
}

/// What a dataset says, or why it cannot be read.
struct ReadDataset {
  nlohmann::json record;
  std::string problem;
  bool may_be_whole = false;  ///< The problem is one of the system.
};

/// Reads datasets, each in a child process, because HDF5 crashes over some that are damaged.
std::vector<ReadDataset> read_datasets(const std::vector<fs::path>& datasets,
                                       const fs::path& folder) {
  constexpr char kRead = 'r';
  constexpr char kProblem = 'x';
  constexpr char kUnread = 'u';
  constexpr double kSeconds = 60;
  const auto answer = [&](std::size_t i) {
    try {
      const std::string icon = read_icon(scan_page_path(folder, datasets[i].stem().string()));
      return kRead + record_of(datasets[i], icon).dump();
    } catch (const io::ReadError& e) {
      return kUnread + std::string(e.what());
    } catch (const std::bad_alloc&) {
      return kUnread + std::string(io::open_error(datasets[i], ENOMEM).what());
    } catch (const std::exception& e) {
      return kProblem + std::string(e.what());
    }
  };
  const auto results =
      in_children(datasets.size(), 1, answer, [](std::size_t) { return kSeconds; });
  std::vector<ReadDataset> read(datasets.size());
  for (std::size_t i = 0; i < datasets.size(); ++i) {
    const std::string& text = results[i].text;
    const bool ended = results[i].exit_code == 0 && !text.empty();
    read[i].may_be_whole = ended ? text.front() == kUnread : !tells_of_damage(results[i]);
    if (!ended)
      read[i].problem = unfinished_reading(results[i], datasets[i]).what();
    else if (text.front() == kRead)
      read[i].record = nlohmann::json::parse(text.substr(1));
    else
      read[i].problem = text.substr(1);
  }
  return read;
}

/// Returns a relative path as a URL, in which every byte but letters, digits and some marks is %XX.
std::string url_of(const std::string& path) {
  constexpr std::string_view kPlain = "-._~/";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string url;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || kPlain.find(c) != std::string_view::npos)
      url += c;
    else
      url.append({'%', kDigits[byte >> 4], kDigits[byte & 15]});
  }
  return url;
}

io::Error no_archive(const fs::path& folder) {
  return {folder, "", "is no archive: it has no datasets and no journal",
          "give the folder that was --output of a run"};
}

/// Returns the state of the last run. The run that makes this page is still running, but it has
/// ended in all other things.
std::string shown_state(const ArchiveStatus& status, const RunHistory& history) {
  const bool is_at_pages = status.is_running() && history.running.empty();
  return is_at_pages ? "ended" : state_of(status);
}

/// Returns what tells the names of scans that the archive has or knows.
auto shown_names(const std::vector<fs::path>& datasets, const Sources& sources) {
  std::set<std::string> names;
  for (const fs::path& dataset : datasets) names.insert(dataset.stem().string());
  for (const auto& [name, source] : sources.by_name()) names.insert(name);
  return [names = std::move(names)](const std::string& name) { return names.contains(name); };
}

class ReportReader {
 public:
  ReportReader(const fs::path& archive, const fs::path& folder)
      : archive_(archive),
        folder_(folder),
        status_(status_of(archive)),
        sources_(Sources::read(archive)),
        datasets_(dataset_files(archive / "scans")),
        history_(read_history(archive, shown_names(datasets_, sources_))) {}

  nlohmann::json read() {
    const std::vector<ReadDataset> read = read_datasets(datasets_, folder_);
    std::map<std::string, const ReadDataset*> names;
    for (std::size_t i = 0; i < datasets_.size(); ++i)
      names[datasets_[i].stem().string()] = &read[i];
    for (const auto& [name, source] : sources_.by_name()) names.try_emplace(name);
    // What could not be read as a scan has no dataset and no source.
    for (const auto& [job, error] : history_.night.failed)
      if (job.starts_with(kSurface)) names.try_emplace(job.substr(kSurface.size()));
    if (names.empty() && !status_.last_run) throw no_archive(archive_);
    for (const auto& [name, dataset] : names) {
      scans_.push_back(scan(name, dataset));
      titles_[name] = scans_.back()["title"];
    }
    std::ranges::stable_sort(scans_, {}, [](const nlohmann::json& s) { return order_of(s); });
    nlohmann::json scenes = scenes_of_archive();
    for (const ReadDataset& dataset : read)
      if (dataset.may_be_whole) unread_.push_back(dataset.problem);
    return {{"archive", escaped(fs::weakly_canonical(archive_).filename().string())},
            {"run", run()},
            {"failures", failures()},
            {"scans", scans_},
            {"scenes", std::move(scenes)},
            {"unread", unread_}};
  }

 private:
  static std::size_t order_of(const nlohmann::json& scan) {
    constexpr std::array<std::string_view, 6> kOrder = {"failed",  "damaged", "skipped",
                                                        "missing", "running", "done"};
    return std::ranges::find(kOrder, scan["state"].get<std::string>()) - kOrder.begin();
  }

  nlohmann::json run() const {
    if (history_.run.started.empty()) return {{"state", state_of(status_)}};
    nlohmann::json run = figures_of(history_.night);
    run["state"] = shown_state(status_, history_);
    return run;
  }

  nlohmann::json scan(const std::string& name, const ReadDataset* dataset) const {
    nlohmann::json record = {{"name", name}, {"title", title_of(name)}};
    if (const auto made = history_.made.find(name); made != history_.made.end()) {
      record["seconds"] = made->second.seconds;
      record["peak_bytes"] = made->second.peak_bytes;
    }
    if (dataset != nullptr && !dataset->problem.empty()) {
      record["state"] = "damaged";
      add_reason(record, dataset->problem);
      return record;
    }
    if (dataset != nullptr) {
      record.update(dataset->record);
      add_page(record, scan_page_path(folder_, name));
    }
    add_state(record, name, dataset != nullptr);
    return record;
  }

  /// Returns the path of a scan below the folder in which it was found, or the name of its dataset
  /// if the archive does not know it.
  std::string title_of(const std::string& name) const {
    const auto source = sources_.by_name().find(name);
    if (source == sources_.by_name().end()) return name;
    return escaped(given_name(source->second, name));
  }

  /// Returns the title of a scan as the table of scans has it.
  std::string shown_title_of(const std::string& name) const {
    const auto title = titles_.find(name);
    return title == titles_.end() ? title_of(name) : title->second;
  }

  void add_state(nlohmann::json& record, const std::string& name, bool has_dataset) const {
    const auto last = history_.last.find(name);
    const std::string ended = last == history_.last.end() ? "" : last->second.state;
    if (status_.is_running() && history_.running.contains(std::string(kSurface) + name)) {
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
    for (const auto& [job, error] : history_.run.failed) {
      if (job.starts_with(kSurface)) continue;
      nlohmann::json failure = {{"job", job}};
      add_reason(failure, error);
      list.push_back(std::move(failure));
    }
    return list;
  }

  /// Adds the page of a scan or a scene, if it is there.
  void add_page(nlohmann::json& record, const fs::path& page) const {
    if (!io::is_there(page)) return;
    record["page"] =
        url_of(page.parent_path().filename().string() + "/" + page.filename().string());
  }

  nlohmann::json scenes_of_archive() {
    nlohmann::json list = nlohmann::json::array();
    for (const std::string& name : scene_names(archive_)) list.push_back(scene(name));
    return list;
  }

  nlohmann::json scene(const std::string& name) {
    nlohmann::json record = {{"name", escaped(name)}, {"title", escaped(name)}};
    try {
      const nlohmann::json document = read_recognised(archive_ / "recognised" / (name + ".json"));
      record["title"] = document.at("scene").at("input_name");
      record["vertices"] = document.at("scene").at("vertices");
      record["features"] = document.at("scene").at("features");
      record["models_ranked"] = document.at("models_ranked");
      record["objects"] = nlohmann::json::array();
      for (const nlohmann::json& object : document.at("objects"))
        record["objects"].push_back(
            {{"title", shown_title_of(object.at("model"))}, {"score", object.at("score")}});
      add_page(record, scene_page_path(folder_, name));
    } catch (const io::ReadError& e) {
      add_reason(record, e.what());
      unread_.push_back(e.what());
    } catch (const io::Error& e) {
      add_reason(record, e.what());
    } catch (const nlohmann::json::exception&) {
      record["reason"] = "it lacks a field";
      record["remedy"] = "remove it, and recognise the scene again";
    }
    return record;
  }

  fs::path archive_;
  fs::path folder_;
  ArchiveStatus status_;
  Sources sources_;
  std::vector<fs::path> datasets_;
  RunHistory history_;
  std::vector<nlohmann::json> scans_;
  nlohmann::json unread_ = nlohmann::json::array();  ///< Sentences about what may be whole.
  std::map<std::string, std::string> titles_;        ///< Titles of the scans by their names.
};

/// Returns the key of a page, or an empty text if there is none. Throws io::ReadError if the system
/// refuses to read it.
std::string key_of_page(const fs::path& page) {
  try {
    return read_page_key(page);
  } catch (const io::Error& e) {
    io::rethrow_if_unread(e);
    return "";
  }
}

/// Returns what says whether a dataset is another one. Throws io::ReadError if the system refuses
/// to read it.
std::string state_of_dataset(const fs::path& dataset) {
  try {
    return io::read_origin(dataset).job_key;
  } catch (const io::Error& e) {
    io::rethrow_if_unread(e);
    return e.what();
  }
}

}  // namespace

std::vector<std::string> scene_names(const fs::path& archive) {
  std::vector<std::string> names;
  for (const fs::path& file : files_with_extension(archive / "recognised", ".json"))
    names.push_back(file.stem().string());
  std::erase(names, "sources");
  return names;
}

std::string archive_digest(const fs::path& archive, const fs::path& folder) try {
  const std::vector<fs::path> datasets = dataset_files(archive / "scans");
  const Sources sources = Sources::read(archive);
  const RunHistory history = read_history(archive, shown_names(datasets, sources));
  std::string content = history.digest + shown_state(status_of(archive), history);
  const auto add = [&](const std::string& text) { content.append("\n").append(text); };
  if (datasets.empty() && !io::is_there(archive / kJournalName)) throw no_archive(archive);
  for (const fs::path& dataset : datasets) {
    add(dataset.filename().string());
    add(state_of_dataset(dataset));
    add(key_of_page(scan_page_path(folder, dataset.stem().string())));
  }
  for (const auto& [name, source] : sources.by_name()) add(name);
  for (const std::string& name : scene_names(archive)) {
    add(name);
    add(key_of_page(scene_page_path(folder, name)));
    add(std::to_string(io::InputFile(archive / "recognised" / (name + ".json")).size()));
  }
  return io::xxh3_of_text(content);
} catch (const io::ReadError&) {
  return "";
}

nlohmann::json archive_report(const fs::path& archive, const fs::path& folder) {
  return ReportReader(archive, folder).read();
}

}  // namespace semigeo::jobs
