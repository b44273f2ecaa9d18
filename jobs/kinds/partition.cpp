#include "jobs/kinds/partition.hpp"

#include <cstdio>
#include <utility>

#include "io/files/file_digest.hpp"
#include "io/files/json_value.hpp"
#include "io/library/posting_partition.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/merging.hpp"
#include "jobs/plan/plan.hpp"
#include "jobs/plan/typed_job_kind.hpp"
#include "jobs/stages/partition_job.hpp"

namespace semigeo::jobs {

namespace fs = std::filesystem;
using nlohmann::json;

/// It is raised whenever the same runs give other bytes.
static constexpr const char* kVersion = "partition 1";

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PartitionJobResult, postings)

static void to_json(json& object, const PartitionJobData& data) {
  object = {{"models", escaped_all(data.models)},
            {"shapes", {data.shapes.first, data.shapes.end}},
            {"partitions", data.partitions},
            {"library", escaped(data.library.string())},
            {"parameters", json_of(data.parameters)}};
}

static void from_json(const json& object, PartitionJobData& data) {
  data.models = unescaped_all(object.at("models").get<std::vector<std::string>>());
  io::read_value(object.at("shapes").at(0), data.shapes.first);
  io::read_value(object.at("shapes").at(1), data.shapes.end);
  io::read_value(object.at("partitions"), data.partitions);
  data.library = unescaped(object.at("library").get<std::string>());
  data.parameters = recognition_parameters_from_json(object.at("parameters"));
}

namespace {

class PartitionKind final : public TypedJobKind<PartitionJobData, PartitionJobResult> {
 public:
  const JobWords& words() const override { return words_; }

  std::string read_key(const fs::path& output, KeyCheck) const override {
    return io::posting_partition_key(output);
  }

  /// The partition is made of the models that have runs. It is not needed if their library is
  /// there.
  bool resolve_inputs(Job& job, OutputKeys& keys) const override {
    PartitionJobData& partition = data(job);
    const auto run_keys = keep_models_with_runs(partition.models, job.input, job.output, keys);
    job.key = partition_key(run_keys, partition.shapes);
    return is_complete(job) || is_complete(library_job({.models = {},
                                                        .partitions = partition.partitions,
                                                        .parameters = partition.parameters},
                                                       partition.library, job.input, run_keys));
  }

  Estimate estimate(const PlannedJob& planned, const EstimateContext& context) const override {
    const PartitionJobData& partition = data(planned.job);
    return merging_estimate(partition.models.size(), partition.partitions, context.memory_bytes);
  }

  std::any run(const Job& job, const JobContext& context) const override {
    const PartitionJobData& partition = data(job);
    return run_partition_job({.runs = run_paths(job.input, partition.models),
                              .shapes = partition.shapes,
                              .output = job.output,
                              .key = job.key,
                              .memory_bytes = buffer_bytes(context.memory_bytes)},
                             context.engine);
  }

 private:
  const JobWords words_ = {.kind = "partition",
                           .output = "postings",
                           .inputs = "the models",
                           .plural = "jobs of a library",
                           .merges_files = true};
};

}  // namespace

const JobKind& partition_kind() {
  static const PartitionKind kind;
  return kind;
}

Job partition_job(int number, PartitionJobData data, const fs::path& parts,
                  std::span<const std::string> run_keys) {
  const fs::path output = partition_path(parts, number);
  std::string key = partition_key(run_keys, data.shapes);
  return {.kind = &partition_kind(),
          .name = output.filename().string(),
          .input = parts,
          .output = output,
          .key = std::move(key),
          .data = std::move(data)};
}

fs::path partition_path(const fs::path& parts, int number) {
  char name[16];
  std::snprintf(name, sizeof name, "%03d.part", number);
  return parts / "partitions" / name;
}

std::string partition_key(std::span<const std::string> run_keys, const io::ShapeRange& shapes) {
  std::string text = std::string(kVersion) + '\n' + std::to_string(shapes.first) + ' ' +
                     std::to_string(shapes.end);
  for (const std::string& key : run_keys) text += '\n' + key;
  return io::xxh3_of_text(text);
}

}  // namespace semigeo::jobs
