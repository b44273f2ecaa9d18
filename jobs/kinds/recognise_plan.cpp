#include "jobs/kinds/recognise_plan.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/utf8.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/kinds/library_plan.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// Returns whether the folder has a recognised file of this name, made of a scene with these bytes.
bool is_of(const fs::path& folder, const std::string& name, const std::string& xxh3) {
  try {
    return read_recognised(recognised_path(folder, name)).at("scene").at("xxh3") == xxh3;
  } catch (const io::Error&) {
    return false;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace

fs::path recognised_folder(const fs::path& folder) {
  return folder / "recognised";
}

fs::path recognised_path(const fs::path& folder, const std::string& name) {
  return recognised_folder(folder) / (name + ".json");
}

SearchedLibrary searched_library(const fs::path& file_or_archive) {
  const fs::path given = fs::absolute(file_or_archive).lexically_normal();
  const bool is_folder = io::is_folder(given);
  const fs::path path = is_folder ? place_of_archive(given).library : given;
  if (!io::is_there(path))
    throw io::Error(path, "", is_folder ? "the folder has no hash library" : "no such library",
                    is_folder ? "build it: semigeo library build " + file_or_archive.string()
                              : "check --library");
  const io::HashLibrary library(path);
  return {.path = path,
          .digest = library.digest(),
          .models = library.models().size(),
          .parameters = parameters_of(library)};
}

std::vector<PlannedJob> plan_recognition(const std::vector<FoundScan>& scenes,
                                         const SearchedLibrary& library,
                                         const SearchParameters& parameters, const fs::path& folder,
                                         int threads) {
  std::vector<PlannedJob> plan(scenes.size());
  std::vector<RecogniseJobData> data(scenes.size());
  std::vector<Unnamed> unnamed;
  std::vector<ScanDigest> digests = DigestCache(folder).scan_digests(scenes, threads);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    PlannedJob& planned = plan[i];
    planned.job.kind = &recognise_kind();
    planned.job.input = scenes[i].input;
    planned.scan = scenes[i].file;
    planned.member_bytes = scenes[i].bytes + digests[i].companion_bytes;
    planned.error = std::move(digests[i].error);
    data[i] = {.input_name = io::as_utf8(scenes[i].relative),
               .input_xxh3 = std::move(digests[i].xxh3),
               .library = library.path,
               .library_digest = library.digest,
               .parameters = library.parameters,
               .search = parameters};
    unnamed.push_back({scenes[i].name, scenes[i].file, data[i].input_xxh3});
  }
  const auto names = choose_names(
      unnamed, Sources::read(recognised_folder(folder)),
      [&](const std::string& name, const std::string& xxh3) { return is_of(folder, name, xxh3); });
  for (std::size_t i = 0; i < plan.size(); ++i) {
    Job& job = plan[i].job;
    job.name = names[i];
    job.output = recognised_path(folder, job.name);
    job.key = recognise_key(job.name, data[i]);
    job.data = std::move(data[i]);
    if (is_readable(plan[i])) judge_output(plan[i]);
  }
  return plan;
}

void record_scenes(const fs::path& folder, const std::vector<PlannedJob>& plan) {
  std::error_code ignored;  // writing says why
  fs::create_directories(recognised_folder(folder), ignored);
  Sources sources = Sources::read(recognised_folder(folder));
  for (const PlannedJob& planned : plan)
    if (is_readable(planned)) sources.claim(planned.job.name, planned.scan);
  sources.write(recognised_folder(folder));
}

}  // namespace semigeo::jobs
