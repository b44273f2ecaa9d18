#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>

#include "jobs/bench/cases.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/level_features.hpp"
#include "kernels/evolution/evolution.hpp"
#include "kernels/lanes/evolve_vertices.hpp"

namespace semigeo::jobs {
namespace {

/// A thread takes so many vertices at a time, as in a job.
constexpr std::int64_t kVertexBlock = 512;

/// Patches must read and write at least so many bytes for each vertex: its own, and two faces.
constexpr double kPatchBytes = sizeof(Eigen::Vector4f) + sizeof(Eigen::Vector3f) +
                               sizeof(std::int32_t) + sizeof(kernels::EvolvedVertex) +
                               2 * (sizeof(kernels::GeodesicFace) + sizeof(kernels::QuadraticFace));

using SurfaceOf = const kernels::Surface& (BenchInputs::*)();

/// Holds a surface at level 0, ready for its patches, and a copy of it that may evolve.
class LevelZero {
 public:
  LevelZero(BenchInputsPointer inputs, SurfaceOf surface)
      : inputs_(std::move(inputs)), surface_(surface) {}

  engine::RunContext context(engine::Workers& workers) {
    return {workers, inputs_->observer(), {}};
  }
  /// Makes the surface, with the normals of level 0.
  EvolvingSurface& first(engine::Workers& workers) {
    if (first_) return *first_;
    first_.emplace((*inputs_.*surface_)(), EvolutionOptions{}, context(workers));
    for (std::int32_t v = 0; v < first_->vertex_count(); ++v)
      edges_.push_back(kernels::first_edge(first_->sampled().mesh, v));
    results_.resize(edges_.size());
    return *first_;
  }
  /// Makes a new copy of it, which may move.
  void copy(engine::Workers& workers) { copy_.emplace(first(workers)); }

  BenchWork evolve(engine::Workers& workers) {
    const auto vertices = static_cast<double>(copy_->vertex_count());
    const LevelFields fields = copy_->evaluate();
    find_features(*copy_, fields, {}, context(workers));
    copy_->move();
    // Faces are prepared anew, so everything is written and read a second time.
    return {
        .amount = vertices, .vertex_levels = vertices, .memory_bytes = 2 * kPatchBytes * vertices};
  }

  BenchWork patches(kernels::InstructionSet set, engine::Workers& workers) {
    const kernels::SampledSurface surface = first_->sampled();
    const kernels::PatchLayout layout = first_->layout();
    workers.for_blocks(first_->vertex_count(), kVertexBlock, [&](engine::IndexRange range) {
      const auto begin = static_cast<std::size_t>(range.begin);
      const auto count = static_cast<std::size_t>(range.end - range.begin);
      kernels::evolve_vertices(surface, std::span(edges_).subspan(begin, count), layout, set,
                               std::span(results_).subspan(begin, count));
    });
    const auto vertices = static_cast<double>(first_->vertex_count());
    return {.amount = vertices, .vertex_levels = vertices, .memory_bytes = kPatchBytes * vertices};
  }

 private:
  BenchInputsPointer inputs_;
  SurfaceOf surface_;
  std::optional<EvolvingSurface> first_;
  std::optional<EvolvingSurface> copy_;
  std::vector<std::int32_t> edges_;  ///< The first edge of each patch.
  std::vector<kernels::EvolvedVertex> results_;
};

struct NamedSurface {
  const char* name;
  SurfaceOf surface;
};
constexpr NamedSurface kSurfaces[] = {{"even", &BenchInputs::even_surface},
                                      {"scan", &BenchInputs::scan_surface}};

}  // namespace

void add_level_cases(std::vector<BenchCase>& cases, const BenchInputsPointer& inputs,
                     const std::vector<int>& threads) {
  using engine::Workers;
  std::vector<BenchCase> whole_levels;
  for (const NamedSurface& named : kSurfaces) {
    const std::string surface = std::string("/") + named.name;
    std::vector<std::shared_ptr<LevelZero>> levels;  // one for each number of threads
    for (const int count : threads) {
      levels.push_back(std::make_shared<LevelZero>(inputs, named.surface));
      whole_levels.push_back(
          {.name = "level" + surface,
           .unit = "vertex levels/s",
           .threads = count,
           .run = [level = levels.back()](Workers& workers) { return level->evolve(workers); },
           .prepare = [level = levels.back()](Workers& workers) { level->copy(workers); }});
    }
    for (const kernels::InstructionSet set : kernels::kInstructionSets)
      for (std::size_t i = 0; supported(set) && i < threads.size(); ++i)
        cases.push_back(
            {.name = "kernel/" + std::string(name_of(set)) + surface,
             .unit = "vertex levels/s",
             .threads = threads[i],
             .run = [level = levels[i],
                     set](Workers& workers) { return level->patches(set, workers); },
             .prepare = [level = levels[i]](Workers& workers) { level->first(workers); }});
  }
  std::ranges::move(whole_levels, std::back_inserter(cases));
}

}  // namespace semigeo::jobs
