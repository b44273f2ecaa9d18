#include "jobs/stages/resemblance.hpp"

#include <cstdint>

#include "kernels/recognition/surflet_histogram.hpp"

namespace semigeo::jobs {

std::vector<double> resemblances(const io::HashLibrary& library,
                                 const kernels::RecognitionModel& scene,
                                 const engine::RunContext& context) {
  const kernels::SurfletHistogram of_scene = kernels::surflet_histogram(scene.samples);
  const auto count = static_cast<std::int64_t>(library.models().size());
  std::vector<double> result(library.models().size());
  context.workers.for_blocks(count, 1, [&](engine::IndexRange range) {
    for (auto i = range.begin; i < range.end; ++i)
      result[i] =
          kernels::resemblance(of_scene, kernels::surflet_histogram(library.read_model(i).samples));
  });
  return result;
}

}  // namespace semigeo::jobs
