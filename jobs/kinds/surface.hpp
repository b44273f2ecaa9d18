#pragma once

#include <filesystem>
#include <string>

#include "jobs/plan/job_kind.hpp"
#include "jobs/stages/surface_parameters.hpp"

namespace semigeo::jobs {

/// The data of a surface job, which makes a dataset of a scan.
struct SurfaceJobData {
  std::string input_name = {};  ///< Name of the scan in the dataset, as UTF-8.
  std::string input_xxh3 = {};  ///< Digest of the scan's bytes.
  SurfaceParameters parameters = {};
  bool sidecar_only = false;  ///< Only the dataset's .xdmf is to be made again, if possible.
};

/// The kind whose jobs make one dataset of one scan (jobs/stages/surface_job.hpp). The data of its
/// jobs is a SurfaceJobData, their result a SurfaceJobResult.
const JobKind& surface_kind();

/// Returns the data of a surface job.
const SurfaceJobData& surface_data(const Job& job);
/// Returns the data of a surface job, to change it.
SurfaceJobData& surface_data(Job& job);

/// Returns the key of the dataset of this name that is made of a scan of these bytes.
std::string surface_key(const std::string& name, const std::string& input_xxh3,
                        const std::string& parameters_json);

}  // namespace semigeo::jobs
