#include "jobs/kinds/recognise.hpp"

#include "io/files/file_digest.hpp"
#include "io/scans/scan_reader.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/archive/scan_size.hpp"
#include "jobs/kinds/dataset_estimate.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

/// It is raised whenever the same scene, library and parameters give other bytes.
static constexpr const char* kVersion = "recognise 11";

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RecogniseJobResult, features, triplets, objects)

static void to_json(json& object, const RecogniseJobData& data) {
  object = {{"input_name", data.input_name},
            {"input_xxh3", data.input_xxh3},
            {"library", escaped(data.library.string())},
            {"library_digest", data.library_digest},
            {"parameters", json_of(data.parameters)},
            {"search", json_of(data.search)}};
}

static void from_json(const json& object, RecogniseJobData& data) {
  object.at("input_name").get_to(data.input_name);
  object.at("input_xxh3").get_to(data.input_xxh3);
  data.library = unescaped(object.at("library").get<std::string>());
  object.at("library_digest").get_to(data.library_digest);
  data.parameters = recognition_parameters_from_json(object.at("parameters"));
  data.search = search_parameters_from_json(object.at("search"));
}

namespace {

// The costs of a recognition besides smoothing the scene, for each byte of the library.
constexpr double kBaseBytes = 60e6;
constexpr double kLibraryMemory = 1;
constexpr double kLibrarySeconds = 1e-9;
constexpr double kThesisMemory = 8;
constexpr double kThesisSeconds = 5e-8;
constexpr double kVerifySeconds = 0.5;  // time to verify poses

class RecogniseKind final : public TypedJobKind<RecogniseJobData, RecogniseJobResult> {
 public:
  const JobWords& words() const override { return words_; }

  std::string read_key(const fs::path& output, KeyCheck) const override {
    return recognised_key(output);
  }

  std::vector<ExternalFile> external_files(const PlannedJob& planned) const override {
    return {{.kind = "scene", .path = planned.scan, .is_readable = is_readable(planned)},
            {.kind = "hash library", .path = data(planned.job).library}};
  }

  /// Estimates the smoothing of the scene, and the comparison with the surfaces of candidates.
  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    const RecogniseJobData& recognise = data(planned.job);
    const fs::path& scene = planned.job.input;
    const int levels = recognise.parameters.levels;
    std::error_code error;
    Estimate estimate;
    if (planned.member_bytes > 0 || fs::exists(scene, error))
      estimate = io::is_scan_name(scene) ? context.learned.of(scan_size(planned), levels, 1)
                                         : estimate_of_dataset(scene, levels, context.learned);
    const auto library = static_cast<double>(fs::file_size(recognise.library, error));
    if (error) return estimate;
    const bool thesis = recognise.search.method == RecognitionMethod::kThesis;
    estimate.peak_bytes += kBaseBytes + (thesis ? kThesisMemory : kLibraryMemory) * library;
    estimate.seconds += kVerifySeconds + (thesis ? kThesisSeconds : kLibrarySeconds) * library;
    return estimate;
  }

  std::any run(const Job& job, const JobContext& context) const override {
    const RecogniseJobData& recognise = data(job);
    return run_recognise_job({.scene = job.input,
                              .input_name = recognise.input_name,
                              .name = job.name,
                              .input_xxh3 = recognise.input_xxh3,
                              .library = recognise.library,
                              .library_digest = recognise.library_digest,
                              .output = job.output,
                              .key = job.key},
                             recognise.search, context.engine);
  }

 private:
  const JobWords words_ = {.kind = "recognise",
                           .output = "recognition",
                           .inputs = "the scene, the library",
                           .plural = "scenes"};
};

}  // namespace

const JobKind& recognise_kind() {
  static const RecogniseKind kind;
  return kind;
}

const RecogniseJobData& recognise_data(const Job& job) {
  return RecogniseKind::data(job);
}

std::string recognise_key(const std::string& name, const RecogniseJobData& data) {
  return io::xxh3_of_text(std::string(kVersion) + '\n' + to_json(data.search) + '\n' + name + '\n' +
                          data.input_name + '\n' + data.input_xxh3 + '\n' + data.library_digest);
}

}  // namespace semigeo::jobs
