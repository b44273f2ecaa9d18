#include "jobs/stages/triplets_job.hpp"

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "io/library/triplet_run.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "kernels/recognition/triplet.hpp"

namespace semigeo::jobs {

TripletsJobResult run_triplets_job(const TripletsJob& job, const RecognitionParameters& parameters,
                                   const engine::RunContext& context) {
  const io::Dataset dataset(job.dataset);
  kernels::RecognitionModel model = recognition_model(dataset, parameters, context);
  model.name = job.name;
  if (const auto problem = io::problem_of(io::pack_model(model)))
    throw io::Error(job.dataset, "", "what recognition makes of it " + *problem,
                    "give the scan in a unit in which its size is an ordinary number");
  const std::vector<kernels::Triplet> triplets = kernels::local_triplets(model.features, {});
  io::write_triplet_run(job.output, job.key_of(dataset.header().job_key), model, triplets);
  return {.features = static_cast<std::int64_t>(model.features.features.size()),
          .samples = static_cast<std::int64_t>(model.samples.points.size()),
          .triplets = static_cast<std::int64_t>(triplets.size())};
}

}  // namespace semigeo::jobs
