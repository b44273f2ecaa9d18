#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/library/shape_range.hpp"

namespace semigeo::jobs {

/// In the order in which they depend on each other.
enum class JobKind {
  kSurface,    ///< scan in, dataset out
  kTriplets,   ///< dataset in, run out
  kPartition,  ///< runs of all models in, the postings of some shapes out
  kLibrary,    ///< runs and partitions in, library out
  kRecognise   ///< scene and library in, what of it is in the scene out
};
inline constexpr std::array kJobKinds = {JobKind::kSurface, JobKind::kTriplets, JobKind::kPartition,
                                         JobKind::kLibrary, JobKind::kRecognise};

/// "surface", "triplets", ...
std::string_view name_of(JobKind kind);
/// The same of the file that it makes: "dataset", "run", ...
std::string_view output_name_of(JobKind kind);

/// From files to one file. Whatever is not said to be of a kind is of all.
struct Job {
  JobKind kind = JobKind::kSurface;
  std::string name;  ///< of the dataset, the scene; of partition and library, its file's
  std::filesystem::path
      input;  ///< the scan; the dataset; the folder of runs and partitions; the scene
  std::filesystem::path output;
  std::string key;              ///< hash of kind, code version, parameters and inputs: job_key
  std::string input_name = {};  ///< surface, recognise: what the output says of it, as UTF-8
  std::string input_xxh3 = {};  ///< surface, recognise: of its bytes
  std::vector<std::string> models = {};  ///< partition, library: names of all, sorted
  io::ShapeRange shapes = {};            ///< partition
  std::filesystem::path library =
      {};                           ///< partition: what it is a part of; recognise: where it looks
  std::string library_digest = {};  ///< recognise: of its content
  int partitions = 0;               ///< library: how many there are
  std::int64_t buffer_bytes = 0;    ///< partition, library: of memory; 0: as they like
};

/// "surface <name>": what the journal, logs and the graph call the job.
std::string job_id(const Job& job);

/// What messages about the job name: the file that it was given, or the one that it makes of many.
const std::filesystem::path& subject_of(const Job& job);

/// Where the folder of a library's parts has those of a name or a number.
std::filesystem::path run_path(const std::filesystem::path& parts, const std::string& model);
std::filesystem::path partition_path(const std::filesystem::path& parts, int number);

/// The key that the job's output carries; empty if there is none, or it cannot be read.
std::string output_key(const Job& job);
/// The same, but without a look at what checksums protect: for many runs at once.
std::string output_key_in_head(const Job& job);

/// Whether the output is there, made under the job's key; a dataset's sidecar beside it.
bool is_complete(const Job& job);

}  // namespace semigeo::jobs
