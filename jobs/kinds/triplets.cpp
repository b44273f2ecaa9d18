#include "jobs/kinds/triplets.hpp"

#include "io/dataset/dataset.hpp"
#include "io/files/file_digest.hpp"
#include "io/files/read_error.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/archive/scan_size.hpp"
#include "jobs/kinds/dataset_estimate.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/stages/triplets_job.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

/// It is raised whenever the same dataset and parameters give other bytes.
static constexpr const char* kVersion = "triplets 2";

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TripletsJobResult, features, samples, triplets)

static void to_json(json& object, const TripletsJobData& data) {
  object = {{"parameters", json_of(data.parameters)}};
}

static void from_json(const json& object, TripletsJobData& data) {
  data.parameters = recognition_parameters_from_json(object.at("parameters"));
}

namespace {

class TripletsKind final : public TypedJobKind<TripletsJobData, TripletsJobResult> {
 public:
  const JobWords& words() const override { return words_; }

  std::string read_key(const fs::path& output, KeyCheck check) const override {
    return check == KeyCheck::kWhole ? io::triplet_run_key(output)
                                     : io::TripletRun(output).job_key();
  }

  /// Takes the key of the dataset that is there now. Throws io::Error if there is none.
  bool resolve_inputs(Job& job, OutputKeys&) const override {
    job.key.clear();
    if (!io::is_there(job.input)) throw missing_input(job.output, "dataset");
    job.key = triplets_key(job.name, io::read_origin(job.input).job_key, data(job).parameters);
    return is_complete(job);
  }

  /// Removes the run of another dataset, which must not get into a library. What cannot be read
  /// cannot get into it either, and stays.
  void remove_stale_output(const Job& job) const override {
    std::error_code ignored;
    try {
      if (!is_complete(job)) fs::remove(job.output, ignored);
    } catch (const io::ReadError&) {
    }
  }

  std::vector<ExternalFile> external_files(const PlannedJob& planned) const override {
    if (!planned.after.empty()) return {};
    return {{.kind = "dataset", .path = planned.job.input, .is_readable = is_readable(planned)}};
  }

  /// Estimates a surface job with fewer levels, because level 0 is smoothed again.
  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    const int levels = data(planned.job).parameters.levels;
    if (!planned.after.empty() && !context.plan[planned.after.front()].up_to_date)
      return context.learned.of(scan_size(context.plan[planned.after.front()]), levels, 1);
    return estimate_of_dataset(planned.job.input, levels, context.learned);
  }

  std::any run(const Job& job, const JobContext& context) const override {
    const RecognitionParameters& parameters = data(job).parameters;
    return run_triplets_job({.dataset = job.input,
                             .name = job.name,
                             .output = job.output,
                             .key_of =
                                 [&](const std::string& dataset_key) {
                                   return triplets_key(job.name, dataset_key, parameters);
                                 }},
                            parameters, context.engine);
  }

 private:
  const JobWords words_ = {
      .kind = "triplets", .output = "run", .inputs = "the dataset", .plural = "jobs of a library"};
};

}  // namespace

const JobKind& triplets_kind() {
  static const TripletsKind kind;
  return kind;
}

Job triplets_job(const std::string& model, const fs::path& dataset, const std::string& dataset_key,
                 const fs::path& parts, const RecognitionParameters& parameters) {
  return {.kind = &triplets_kind(),
          .name = model,
          .input = dataset,
          .output = run_path(parts, model),
          .key = triplets_key(model, dataset_key, parameters),
          .data = TripletsJobData{parameters}};
}

fs::path run_path(const fs::path& parts, const std::string& model) {
  return parts / "triplets" / (model + ".run");
}

std::string triplets_key(const std::string& model, const std::string& dataset_key,
                         const RecognitionParameters& parameters) {
  return io::xxh3_of_text(std::string(kVersion) + '\n' + to_json(parameters) + '\n' + model + '\n' +
                          dataset_key);
}

}  // namespace semigeo::jobs
