#include "jobs/kinds/library.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/json_value.hpp"
#include "io/files/read_error.hpp"
#include "io/library/hash_library.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/kinds/given_names.hpp"
#include "jobs/kinds/merging.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/stages/library_job.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

/// It is raised whenever the same runs and parameters give other bytes.
static constexpr const char* kVersion = "library 1";

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LibraryJobResult, models, postings, digest)

static void to_json(json& object, const LibraryJobData& data) {
  object = {{"models", escaped_all(data.models)},
            {"partitions", data.partitions},
            {"parameters", json_of(data.parameters)}};
}

static void from_json(const json& object, LibraryJobData& data) {
  data.models = unescaped_all(object.at("models").get<std::vector<std::string>>());
  io::read_value(object.at("partitions"), data.partitions);
  data.parameters = recognition_parameters_from_json(object.at("parameters"));
}

namespace {

std::vector<fs::path> partition_paths(const Job& job, int partitions) {
  std::vector<fs::path> paths;
  paths.reserve(static_cast<std::size_t>(partitions));
  for (int number = 0; number < partitions; ++number)
    paths.push_back(partition_path(job.input, number));
  return paths;
}

/// Returns "; missing: a, b and 17 more", or an empty text.
std::string missing_in_words(const std::vector<std::string>& missing, const GivenNames& given) {
  constexpr std::size_t kMostNames = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(missing.size(), kMostNames); ++i)
    text += (i == 0 ? "; missing: " : ", ") + given.name_of(missing[i]);
  if (missing.size() > kMostNames)
    text += " and " + std::to_string(missing.size() - kMostNames) + " more";
  return text;
}

class LibraryKind final : public TypedJobKind<LibraryJobData, LibraryJobResult> {
 public:
  const JobWords& words() const override { return words_; }

  std::string read_key(const fs::path& output, KeyCheck) const override {
    return io::library_key(output);
  }

  /// The library is made of the models that have runs, and needs every partition of them.
  bool resolve_inputs(Job& job, OutputKeys& keys) const override {
    LibraryJobData& library = data(job);
    const auto run_keys = keep_models_with_runs(library.models, job.input, job.output, keys);
    job.key = library_key(run_keys, library.parameters);
    if (is_complete(job)) return true;
    for (const fs::path& partition : partition_paths(job, library.partitions))
      if (!io::is_there(partition))
        throw io::Error(partition, "", "is missing: " + job.name + " is made of it",
                        "see why its job failed, and run again");
    return false;
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    return merging_estimate(data(planned.job).models.size(), 1, context.memory_bytes);
  }

  std::any run(const Job& job, const JobContext& context) const override {
    const LibraryJobData& library = data(job);
    return run_library_job({.runs = run_paths(job.input, library.models),
                            .partitions = partition_paths(job, library.partitions),
                            .parameters = json_of(library.parameters),
                            .output = job.output,
                            .key = job.key,
                            .memory_bytes = buffer_bytes(context.memory_bytes)},
                           context.engine);
  }

  std::optional<JobSummary> summary(const Job& job, JobState state) const override {
    const std::vector<std::string> missing = missing_models(job, state);
    const GivenNames given(job.output);
    const std::size_t wanted = data(job).models.size();
    const std::size_t models = wanted - missing.size();
    std::string text = "library: " + job.output.string() + ": ";
    if (is_made(state)) {
      text += std::to_string(models);
      if (!missing.empty()) text += " of " + std::to_string(wanted);
      text += " models";
      if (state == JobState::kUpToDate) text += ", up to date";
      text += missing_in_words(missing, given);
    } else {
      text += name_of(state);
    }
    return JobSummary{.text = std::move(text),
                      .fields = {{"library",
                                  {{"output", job.output.string()},
                                   {"state", name_of(state)},
                                   {"models", models},
                                   {"wanted", wanted},
                                   {"missing", missing}}}},
                      .is_incomplete = is_made(state) && !missing.empty()};
  }

  /// Removes partitions and runs of other models, which nothing needs any more.
  void clean_up(const Job& job) const override {
    std::error_code ignored;
    fs::remove_all(job.input / "partitions", ignored);
    std::set<fs::path> wanted;
    for (const std::string& model : data(job).models)
      wanted.insert(run_path(job.input, model).filename());
    std::vector<fs::path> spare;
    for (const auto& entry : fs::directory_iterator(job.input / "triplets", ignored))
      if (entry.path().extension() == ".run" && !wanted.contains(entry.path().filename()))
        spare.push_back(entry.path());
    for (const fs::path& path : spare) fs::remove_all(path, ignored);
  }

 private:
  const JobWords words_ = {.kind = "library",
                           .output = "hash library",
                           .inputs = "the models",
                           .plural = "jobs of a library",
                           .merges_files = true};
};

}  // namespace

const JobKind& library_kind() {
  static const LibraryKind kind;
  return kind;
}

Job library_job(LibraryJobData data, const fs::path& library, const fs::path& parts,
                std::span<const std::string> run_keys) {
  std::string key = library_key(run_keys, data.parameters);
  return {.kind = &library_kind(),
          .name = library.filename().string(),
          .input = parts,
          .output = library,
          .key = std::move(key),
          .data = std::move(data)};
}

std::string library_key(std::span<const std::string> run_keys,
                        const RecognitionParameters& parameters) {
  std::string text = std::string(kVersion) + '\n' + to_json(parameters);
  for (const std::string& key : run_keys) text += '\n' + key;
  return io::xxh3_of_text(text);
}

std::vector<std::string> missing_models(const Job& library, JobState state) {
  std::set<std::string> there;
  std::error_code ignored;
  try {
    if (is_made(state)) {
      const io::HashLibrary made(library.output);
      for (const io::ModelInfo& model : made.models()) there.insert(model.name);
    }
  } catch (const io::Error&) {
  }
  std::vector<std::string> missing;
  for (const std::string& model : LibraryKind::data(library).models)
    if (is_made(state) ? !there.contains(model)
                       : !fs::exists(run_path(library.input, model), ignored))
      missing.push_back(model);
  return missing;
}

}  // namespace semigeo::jobs
