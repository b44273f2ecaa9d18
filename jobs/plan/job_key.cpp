#include "jobs/plan/job_key.hpp"

#include "io/files/file_digest.hpp"

namespace semigeo::jobs {
namespace {

// Parts of every key: raised whenever the same inputs and parameters give other bytes.
constexpr const char* kSurfaceJobVersion = "surface 10";
constexpr const char* kTripletsJobVersion = "triplets 1";
constexpr const char* kPartitionJobVersion = "partition 1";
constexpr const char* kLibraryJobVersion = "library 1";
constexpr const char* kRecogniseJobVersion = "recognise 2";

std::string joined(std::span<const std::string> keys) {
  std::string text;
  for (const std::string& key : keys) text += '\n' + key;
  return text;
}

}  // namespace

std::string surface_key(const std::string& name, const std::string& input_xxh3,
                        const std::string& parameters_json) {
  return io::xxh3_of_text(std::string(kSurfaceJobVersion) + '\n' + parameters_json + '\n' + name +
                          '\n' + input_xxh3);
}

std::string triplets_key(const std::string& name, const std::string& dataset_key,
                         const RecognitionParameters& parameters) {
  return io::xxh3_of_text(std::string(kTripletsJobVersion) + '\n' + to_json(parameters) + '\n' +
                          name + '\n' + dataset_key);
}

std::string partition_key(std::span<const std::string> run_keys, const io::ShapeRange& shapes) {
  return io::xxh3_of_text(std::string(kPartitionJobVersion) + '\n' + std::to_string(shapes.first) +
                          ' ' + std::to_string(shapes.end) + joined(run_keys));
}

std::string library_key(std::span<const std::string> run_keys,
                        const RecognitionParameters& parameters) {
  return io::xxh3_of_text(std::string(kLibraryJobVersion) + '\n' + to_json(parameters) +
                          joined(run_keys));
}

std::string recognise_key(const std::string& name, const std::string& input_name,
                          const std::string& input_xxh3, const std::string& library_digest,
                          const SearchParameters& parameters) {
  return io::xxh3_of_text(std::string(kRecogniseJobVersion) + '\n' + to_json(parameters) + '\n' +
                          name + '\n' + input_name + '\n' + input_xxh3 + '\n' + library_digest);
}

}  // namespace semigeo::jobs
