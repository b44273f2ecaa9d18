#include "jobs/plan.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <utility>

#include "io/dataset.hpp"
#include "io/error.hpp"
#include "io/file_digest.hpp"
#include "io/scan_reader.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Part of every key: raised whenever the same scan and parameters give other bytes.
constexpr const char* kSurfaceJobVersion = "surface 2";
constexpr std::size_t kSuffixDigits = 8;
constexpr std::size_t kMaxNameLength = 180;

std::string short_hash(const std::string& text) {
  return io::xxh3_of_text(text).substr(0, kSuffixDigits);
}

bool is_safe(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
}

/// Whether "__" in the name could come from anything but a joint of folders.
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

void search_folder(const fs::path& folder, const fs::path& archive, std::vector<FoundScan>& found) {
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                         error);
  if (error)
    throw io::Error(folder, "", "cannot be searched: " + error.message(), "check its permissions");
  for (const fs::recursive_directory_iterator end; entry != end; entry.increment(error)) {
    if (error)
      throw io::Error(folder, "", "cannot be searched: " + error.message(), "check the disk");
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (is_hidden(entry->path()) || fs::equivalent(entry->path(), archive, ignored))
        entry.disable_recursion_pending();
    } else if (!is_hidden(entry->path()) && io::scan_format(entry->path())) {
      files.push_back(entry->path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files)
    found.push_back({file, dataset_name(file.lexically_relative(folder))});
}

void add_file(const fs::path& file, std::vector<FoundScan>& found) {
  if (!io::scan_format(file))
    throw io::Error(file, "", "is not a scan that semigeo reads",
                    "give .ply, .obj, .off or .stl files, also as .gz, or folders of them");
  found.push_back({file, dataset_name(file.filename())});
}

/// By which two paths to one file are known; links that lead nowhere or in circles are themselves.
fs::path identity(const fs::path& file) {
  std::error_code error;
  fs::path canonical = fs::weakly_canonical(file, error);
  return error ? fs::absolute(file).lexically_normal() : canonical;
}

/// Nothing if a dataset with this key exists.
std::optional<std::string> reason_to_run(const SurfaceJob& job) {
  std::error_code ignored;
  if (!fs::exists(job.output, ignored)) return "no dataset yet";
  const auto key = io::complete_job_key(job.output);
  if (!key) return "the dataset is damaged or incomplete";
  if (*key != job.key) return "the scan, the parameters or the version changed";
  return std::nullopt;
}

}  // namespace

std::vector<FoundScan> find_scans(const std::vector<fs::path>& inputs, const fs::path& archive) {
  std::vector<FoundScan> found;
  for (const fs::path& input : inputs) {
    std::error_code error;
    const fs::file_status status = fs::status(input, error);
    if (!fs::exists(status)) throw io::Error(input, "", "no such file or folder", "check the path");
    if (fs::is_directory(status)) {
      search_folder(input, archive, found);
    } else {
      add_file(input, found);
    }
  }

  std::set<std::string> seen_names;
  std::set<fs::path> seen_files;
  std::vector<FoundScan> unique;
  for (FoundScan& scan : found) {
    const fs::path file = identity(scan.input);
    if (!seen_files.insert(file).second) continue;  // named twice
    if (!seen_names.insert(scan.name).second) {
      scan.name += "-" + short_hash(file.string());
      seen_names.insert(scan.name);
    }
    unique.push_back(std::move(scan));
  }
  return unique;
}

std::string job_key(const std::string& name, const std::string& input_xxh3,
                    const SurfaceParameters& parameters) {
  return io::xxh3_of_text(std::string(kSurfaceJobVersion) + '\n' + to_json(parameters) + '\n' +
                          name + '\n' + input_xxh3);
}

std::vector<PlannedJob> plan_jobs(const RunConfig& config) {
  std::vector<PlannedJob> plan;
  for (const FoundScan& scan : find_scans(config.inputs, config.archive)) {
    PlannedJob planned;
    SurfaceJob& job = planned.job;
    job.input = scan.input;
    job.name = scan.name;
    job.output = config.archive / "scans" / (scan.name + ".vtkhdf");
    try {
      job.input_xxh3 = io::xxh3_of_file(scan.input);
      job.key = job_key(scan.name, job.input_xxh3, config.surface);
      const auto reason = reason_to_run(job);
      planned.up_to_date = !reason;
      planned.reason = reason.value_or("");
    } catch (const std::exception& e) {
      planned.error = e.what();
    }
    plan.push_back(std::move(planned));
  }
  return plan;
}

}  // namespace semigeo::jobs
