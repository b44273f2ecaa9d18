#include "jobs/kinds/report.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <set>
#include <system_error>

#include "io/dataset/dataset.hpp"
#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/archive/dataset_files.hpp"
#include "jobs/archive/digest_cache.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/archive/scan_size.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/report/archive_report.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/pages.hpp"
#include "jobs/report/report_files.hpp"
#include "jobs/report/scan_report.hpp"
#include "jobs/report/scene_report.hpp"
#include "jobs/report/thumbnail.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// What a job of the report made.
struct PageResult {
  std::int64_t bytes = 0;
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PageResult, bytes)

}  // namespace

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReportJobResult, scans, failures)

static void to_json(json& object, const PageJobData&) {
  object = json::object();
}
static void from_json(const json&, PageJobData&) {}

static void to_json(json& object, const SceneJobData& data) {
  object = {{"scene", escaped(data.scene.string())}, {"archive", escaped(data.archive.string())}};
}
static void from_json(const json& object, SceneJobData& data) {
  data.scene = unescaped(object.at("scene").get<std::string>());
  data.archive = unescaped(object.at("archive").get<std::string>());
}

static void to_json(json& object, const ReportJobData& data) {
  object = {{"index_only", data.index_only}};
}
static void from_json(const json& object, ReportJobData& data) {
  object.at("index_only").get_to(data.index_only);
}

namespace {

// What a page costs, by the size of its dataset. Measured on pages of datasets from 0.1 to 60 MB,
// of 1 to 9 levels, in both precisions. The memory is that of the largest level, so that a dataset
// of one level decides.
constexpr double kBaseBytes = 35e6;
constexpr double kBytesPerByte = 4;
constexpr double kBaseSeconds = 0.02;
constexpr double kSecondsPerByte = 3e-7;

Estimate estimate_of_page(double bytes) {
  return {.vertices = 0,
          .peak_bytes = kBaseBytes + kBytesPerByte * bytes,
          .seconds = kBaseSeconds + kSecondsPerByte * bytes};
}

double size_of(const fs::path& path) {
  std::error_code error;
  const auto bytes = fs::file_size(path, error);
  return error ? 0 : static_cast<double>(bytes);
}

std::string key_of_scan_page(const std::string& dataset_key, const fs::path& dataset) {
  return page_key(kScanPageVersion, pages().scan, dataset_key + dataset.filename().string());
}

/// What all kinds of pages share.
template <typename Data, typename Result>
class PageKind : public TypedJobKind<Data, Result> {
 public:
  explicit PageKind(JobWords words) : words_(std::move(words)) {}
  const JobWords& words() const override { return words_; }
  std::string read_key(const fs::path& output, KeyCheck) const override {
    return read_page_key(output);
  }

  /// Removes the page of something that is gone.
  void remove_stale_output(const Job& job) const override {
    std::error_code ignored;
    if (is_gone(job.input)) fs::remove(job.output, ignored);
  }

 private:
  const JobWords words_;
};

class ScanPageKind final : public PageKind<PageJobData, PageResult> {
 public:
  ScanPageKind()
      : PageKind({.kind = std::string(kPageKind),
                  .output = "page",
                  .inputs = "the dataset",
                  .plural = "pages"}) {}

  /// Takes the key of the dataset that is there now. Throws io::Error if there is none.
  bool resolve_inputs(Job& job, OutputKeys&) const override {
    job.key.clear();
    if (!io::is_there(job.input)) throw missing_input(job.output, "dataset");
    job.key = key_of_scan_page(io::read_origin(job.input).job_key, job.input);
    return is_complete(job);
  }

  std::vector<ExternalFile> external_files(const PlannedJob& planned) const override {
    if (!planned.after.empty()) return {};
    return {{.kind = "dataset", .path = planned.job.input, .is_readable = is_readable(planned)}};
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext&) const override {
    return estimate_of_page(size_of(planned.job.input));
  }

  std::any run(const Job& job, const JobContext&) const override {
    const io::Dataset dataset(job.input);
    const std::string text =
        with_icon(page_with(pages().scan, scan_report(dataset)), thumbnail_of(dataset));
    write_page(job.output, job.key, text);
    return PageResult{static_cast<std::int64_t>(text.size())};
  }
};

/// Returns the datasets of the models in these lists of a recognised file.
std::set<fs::path> models_in(const json& recognised, std::initializer_list<const char*> lists,
                             const fs::path& archive) {
  std::set<fs::path> datasets;
  for (const char* list : lists)
    for (const json& candidate : recognised.at(list))
      datasets.insert(dataset_of_model(archive, candidate.at("model").get<std::string>()));
  return datasets;
}

/// Returns a text that changes when the file of a scene does.
std::string state_of_scene(const fs::path& scene) {
  const fs::path file = io::outer_file(scene);
  std::optional<FileStamp> stamp = stamp_of(file);
  if (!stamp) {
    if (!io::is_there(file)) return "no scene";
    stamp = stamp_of(file);
  }
  if (!stamp) return "no file";
  return "scene of " + std::to_string(stamp->size) + " bytes, " + std::to_string(stamp->modified);
}

class ScenePageKind final : public PageKind<SceneJobData, PageResult> {
 public:
  ScenePageKind()
      : PageKind({.kind = std::string(kScenePageKind),
                  .output = "page of a scene",
                  .inputs = "what was recognised, or a model",
                  .plural = "pages"}) {}

  bool resolve_inputs(Job& job, OutputKeys&) const override {
    job.key.clear();
    if (!io::is_there(job.input)) throw missing_input(job.output, "recognised file");
    job.key = key_of(job);
    return is_complete(job);
  }

  /// Returns the key of the page of what is there now. Throws io::Error if the recognised file
  /// cannot be read.
  static std::string key_of(const Job& job) {
    const SceneJobData& scene = data(job);
    const json recognised = read_recognised(job.input);
    std::string content = state_of_scene(scene.scene);
    try {
      content.append("\n").append(recognised.at("job_key").get<std::string>());
      for (const fs::path& dataset : models_in(recognised, {"objects", "ranking"}, scene.archive))
        content.append("\n").append(io::is_there(dataset) ? io::read_origin(dataset).job_key
                                                          : "none");
    } catch (const io::Error& e) {
      io::rethrow_if_unread(e);
      content.append("\n").append(e.what());
    } catch (const json::exception& e) {
      content.append("\n").append(e.what());
    }
    return page_key(kScenePageVersion, pages().scene, content);
  }

  std::vector<ExternalFile> external_files(const PlannedJob& planned) const override {
    return {
        {.kind = "recognition", .path = planned.job.input, .is_readable = is_readable(planned)}};
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    Estimate estimate = estimate_of_page(largest_model(planned.job));
    const fs::path& scene = data(planned.job).scene;
    const Estimate reading = io::is_scan_name(scene) ? context.learned.of(scan_size(scene), 1, 1)
                                                     : estimate_of_page(size_of(scene));
    estimate.peak_bytes += reading.peak_bytes;
    estimate.seconds += reading.seconds;
    return estimate;
  }

  /// Returns the size of the largest dataset of the models that were found. They are read one after
  /// the other.
  static double largest_model(const Job& job) {
    double largest = 0;
    try {
      for (const fs::path& dataset :
           models_in(read_recognised(job.input), {"objects"}, data(job).archive))
        largest = std::max(largest, size_of(dataset));
    } catch (const std::exception&) {
      // The job says what is wrong with the file.
    }
    return largest;
  }

  std::any run(const Job& job, const JobContext&) const override {
    const SceneJobData& scene = data(job);
    const std::string text = page_with(
        pages().scene,
        scene_report({.recognised = job.input, .scene = scene.scene, .archive = scene.archive}));
    write_page(job.output, job.key, text);
    return PageResult{static_cast<std::int64_t>(text.size())};
  }
};

/// Removes pages of scans and scenes that are gone. Files that are no pages stay.
void remove_stale_pages(const fs::path& folder, const std::set<fs::path>& wanted) {
  std::vector<fs::path> stale;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().extension() != ".html" || wanted.contains(entry.path())) continue;
    try {
      read_page_key(entry.path());
      stale.push_back(entry.path());
    } catch (const io::Error&) {
    }
  }
  for (const fs::path& path : stale) fs::remove(path, ignored);
}

class ReportKind final : public PageKind<ReportJobData, ReportJobResult> {
 public:
  ReportKind()
      : PageKind({.kind = std::string(kReportKind),
                  .output = "report",
                  .inputs = "datasets, recognised scenes, the journal or pages",
                  .plural = "reports",
                  .merges_files = true}) {}

  /// Leaves the key empty if something cannot be read.
  bool resolve_inputs(Job& job, OutputKeys&) const override {
    job.key = key_of(job);
    return !job.key.empty() && is_complete(job);
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    constexpr double kSecondsPerScan = 0.01;
    constexpr double kBytesPerScan = 30e3;
    const auto scans = static_cast<double>(context.plan.size() + planned.after.size());
    return {.vertices = 0,
            .peak_bytes = kBaseBytes + kBytesPerScan * scans,
            .seconds = kBaseSeconds + kSecondsPerScan * scans};
  }

  std::any run(const Job& job, const JobContext&) const override {
    remove_pages_of_what_is_gone(job);
    json document = archive_report(job.input, job.output.parent_path());
    document["version"] = SEMIGEO_VERSION;
    const json unread = document["unread"];
    document.erase("unread");
    std::string key = job.key.empty() ? key_of(job) : job.key;
    // What could not be read this time may be read the next time.
    if (!unread.empty() || key.empty()) key = page_key(kIndexVersion, pages().index, "unread");
    write_page(job.output, key, page_with(pages().index, document));
    if (!unread.empty())
      throw io::Error(job.output, "",
                      "lacks what cannot be read: " + unread.front().get<std::string>());
    return ReportJobResult{std::ssize(document["scans"]), std::ssize(document["failures"])};
  }

  std::optional<JobSummary> summary(const Job& job, JobState state) const override {
    std::string text = "report: " + job.output.string();
    if (!is_made(state)) text += ": " + std::string(name_of(state));
    if (state == JobState::kUpToDate) text += ", up to date";
    return JobSummary{
        .text = std::move(text),
        .fields = {{"report", {{"output", job.output.string()}, {"state", name_of(state)}}}}};
  }

 private:
  /// Returns the key of the first page, or an empty text if something cannot be read.
  static std::string key_of(const Job& job) {
    const std::string digest = archive_digest(job.input, job.output.parent_path());
    return digest.empty() ? "" : page_key(kIndexVersion, pages().index, digest);
  }

  static void remove_pages_of_what_is_gone(const Job& job) {
    if (data(job).index_only) return;
    const fs::path folder = job.output.parent_path();
    std::set<fs::path> wanted;
    for (const fs::path& dataset : dataset_files(job.input / "scans"))
      wanted.insert(scan_page_path(folder, dataset.stem().string()));
    for (const std::string& name : scene_names(job.input))
      wanted.insert(scene_page_path(folder, name));
    remove_stale_pages(folder / "scans", wanted);
    remove_stale_pages(folder / "scenes", wanted);
  }
};

}  // namespace

const JobKind& page_kind() {
  static const ScanPageKind kind;
  return kind;
}

const JobKind& scene_kind() {
  static const ScenePageKind kind;
  return kind;
}

const JobKind& report_kind() {
  static const ReportKind kind;
  return kind;
}

ReportJobResult shown_on_first_page(const fs::path& page) {
  const json document = read_page_data(page, pages().index);
  if (!document.is_object()) return {};
  return {std::ssize(document.value("scans", json::array())),
          std::ssize(document.value("failures", json::array()))};
}

Job page_job(const std::string& name, const fs::path& dataset, const std::string& dataset_key,
             const fs::path& folder) {
  return {.kind = &page_kind(),
          .name = name,
          .input = dataset,
          .output = scan_page_path(folder, name),
          .key = key_of_scan_page(dataset_key, dataset),
          .data = PageJobData{}};
}

Job scene_job(const std::string& name, const fs::path& scene, const fs::path& archive,
              const fs::path& folder) {
  Job job = {.kind = &scene_kind(),
             .name = name,
             .input = recognised_path(archive, name),
             .output = scene_page_path(folder, name),
             .key = "",
             .data = SceneJobData{.scene = scene, .archive = archive}};
  job.key = ScenePageKind::key_of(job);
  return job;
}

Job report_job(const fs::path& archive, const fs::path& folder, bool index_only) {
  return {.kind = &report_kind(),
          .name = index_path(folder).filename().string(),
          .input = archive,
          .output = index_path(folder),
          .key = "",
          .data = ReportJobData{index_only}};
}

}  // namespace semigeo::jobs
