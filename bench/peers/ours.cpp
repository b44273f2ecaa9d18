#include <cstdlib>
#include <string>
#include <utility>

#include "bench/peers/method.hpp"
#include "jobs/stages/evolving_surface.hpp"
#include "jobs/stages/recognition_features.hpp"
#include "kernels/lanes/instruction_set.hpp"

namespace semigeo::peers {
namespace {

/// Sets SEMIGEO_SIMD, which surfaces read when they are made, while it lives.
class ChosenInstructionSet {
 public:
  explicit ChosenInstructionSet(kernels::InstructionSet set) {
    if (const char* was = std::getenv(kName)) was_ = was;
    setenv(kName, std::string(name_of(set)).c_str(), 1);
  }
  ~ChosenInstructionSet() {
    if (was_.empty())
      unsetenv(kName);
    else
      setenv(kName, was_.c_str(), 1);
  }
  ChosenInstructionSet(const ChosenInstructionSet&) = delete;
  ChosenInstructionSet& operator=(const ChosenInstructionSet&) = delete;

 private:
  static constexpr const char* kName = "SEMIGEO_SIMD";
  std::string was_;
};

/// Runs level 0 from a built surface, and if `further` is set also level 1, which alone is timed.
Result run_level(const Subject& subject, kernels::InstructionSet set, bool further) {
  const ChosenInstructionSet chosen(set);
  engine::Workers worker(1);
  engine::Observer observer;
  kernels::Surface surface = subject.surface;
  double start = cpu_seconds();
  jobs::EvolvingSurface evolving(std::move(surface), {}, {worker, observer, {}});
  const jobs::LevelFields fields = evolving.evaluate();
  Result result;
  result.items = static_cast<double>(subject.surface.vertex_count());
  if (further) {
    start = cpu_seconds();
    evolving.move();
    evolving.evaluate();
    result.seconds = cpu_seconds() - start;
    return result;
  }
  result.seconds = cpu_seconds() - start;
  result.gaussian.assign(fields.gaussian_curvature.begin(), fields.gaussian_curvature.end());
  result.mean.assign(fields.mean_curvature.begin(), fields.mean_curvature.end());
  return result;
}

/// Computes what recognition needs of a model or scene: octave levels, features, samples.
Result run_recognition_model(const Subject& subject) {
  engine::Workers worker(1);
  engine::Observer observer;
  kernels::BuiltSurface built;
  built.surface = subject.surface;
  const double start = cpu_seconds();
  jobs::recognition_model(built, {}, {worker, observer, {}});
  return {cpu_seconds() - start, static_cast<double>(subject.surface.vertex_count()), {}, {}};
}

Method level(kernels::InstructionSet set, bool further) {
  return {std::string(further ? "a further level" : "level 0") + ", " + std::string(name_of(set)),
          [=](const Subject& subject) { return run_level(subject, set, further); }};
}

}  // namespace

Library ours() {
  const auto best = kernels::best_instruction_set();
  constexpr auto kScalar = kernels::InstructionSet::kScalar;
  return {"semigeo",
          "",
          "this build",
          {level(best, false),
           level(best, true),
           level(kScalar, false),
           level(kScalar, true),
           {"features of a model for recognition", run_recognition_model}}};
}

}  // namespace semigeo::peers
