#pragma once

#include <span>
#include <string>

#include "io/library/shape_range.hpp"
#include "jobs/plan/config.hpp"

namespace semigeo::jobs {

// Keys under which outputs are up to date, by content and never by time: equal keys, equal bytes.
// The key of a job contains those of the jobs whose outputs it reads, so that all keys are known
// before anything runs.

std::string surface_key(const std::string& name, const std::string& input_xxh3,
                        const std::string& parameters_json);

/// `dataset_key`: of the job that made the dataset.
std::string triplets_key(const std::string& name, const std::string& dataset_key,
                         const RecognitionParameters& parameters);

/// `run_keys`: of the triplets jobs of all models, in the order of their names.
std::string partition_key(std::span<const std::string> run_keys, const io::ShapeRange& shapes);
std::string library_key(std::span<const std::string> run_keys,
                        const RecognitionParameters& parameters);

/// `library_digest`: of the content of the library in which the scene is looked for.
std::string recognise_key(const std::string& name, const std::string& input_name,
                          const std::string& input_xxh3, const std::string& library_digest,
                          const SearchParameters& parameters);

}  // namespace semigeo::jobs
