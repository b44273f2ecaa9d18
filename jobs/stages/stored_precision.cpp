#include "jobs/stages/stored_precision.hpp"

#include <bit>
#include <cmath>

namespace semigeo::jobs {
namespace {

using Eigen::Vector3f;

constexpr std::int64_t kBlock = 16384;
constexpr float kNormalQuantum = 0x1p-9f;  // the largest power of two up to 2 * kNormalError
static_assert(kNormalQuantum <= 2 * kNormalError && 2 * kNormalQuantum > 2 * kNormalError);

/// Returns the nearest multiple of a power of two, or the number itself if that is 0. Numbers so
/// large that they are multiples anyway stay as they are.
float multiple_of(float value, float quantum) {
  // The last bit of this number has the weight of the quantum, so the sum is rounded to multiples.
  const float carrier = 0x1.8p23f * quantum;
  return std::abs(value) < 0x1p22f * quantum ? (value + carrier) - carrier : value;
}

void round_vector(Vector3f& vector, float quantum) {
  for (float& part : vector) part = multiple_of(part, quantum);
}

/// Returns the number with kSignificantBits bits that is nearest.
float significant(float value) {
  if (!std::isfinite(value)) return value;
  constexpr unsigned kDropped = 24 - kSignificantBits;
  constexpr std::uint32_t kHalf = 1u << (kDropped - 1);
  const auto bits = std::bit_cast<std::uint32_t>(value);
  // The last kept bit decides a tie, so that errors have no direction. A carry goes up into the
  // exponent, as it should.
  const std::uint32_t odd = bits >> kDropped & 1u;
  const std::uint32_t rounded = (bits + kHalf - 1 + odd) & ~((1u << kDropped) - 1);
  const auto result = std::bit_cast<float>(rounded);
  return std::isfinite(result) ? result : value;
}

/// Calls round(number) for each number, on all workers.
template <typename Number, typename Round>
void round_all(std::vector<Number>& numbers, const Round& round, engine::Workers& workers) {
  workers.for_blocks(static_cast<std::int64_t>(numbers.size()), kBlock,
                     [&](engine::IndexRange range) {
                       for (auto i = range.begin; i < range.end; ++i) round(numbers[i]);
                     });
}

void round_feature(kernels::Feature& feature, float quantum, float first_quantum) {
  round_vector(feature.position, quantum);
  round_vector(feature.initial_position, first_quantum);
  round_vector(feature.normal, kNormalQuantum);
  for (float* number : {&feature.value, &feature.prominence, &feature.scale_free_gaussian,
                        &feature.scale_free_mean})
    *number = significant(*number);
}

}  // namespace

float position_quantum(double step) {
  if (!(step > 0) || !std::isfinite(step)) return 0;
  const int exponent = std::ilogb(2 * kPositionShare * step);
  // A quantum or a quotient that floats cannot hold would spoil positions.
  constexpr int kLeast = -100;
  constexpr int kMost = 100;
  return exponent < kLeast || exponent > kMost ? 0 : std::ldexp(1.0f, exponent);
}

void round_to_scan(LevelFields& fields, kernels::LevelFeatures& features, double first_step,
                   bool first, engine::Workers& workers) {
  const float quantum = position_quantum(fields.step);
  const float first_quantum = position_quantum(first_step);
  const auto round_number = [](float& number) { number = significant(number); };
  const auto round_position = [quantum](Vector3f& point) { round_vector(point, quantum); };
  const auto round_unit = [](Vector3f& vector) { round_vector(vector, kNormalQuantum); };
  if (!first) round_all(fields.points, round_position, workers);
  for (std::vector<Vector3f>* vectors :
       {&fields.normals, &fields.principal_direction_1, &fields.principal_direction_2})
    round_all(*vectors, round_unit, workers);
  for (std::vector<float>* numbers :
       {&fields.gaussian_curvature, &fields.mean_curvature, &fields.patch_completeness,
        &fields.principal_curvature_1, &fields.principal_curvature_2})
    round_all(*numbers, round_number, workers);
  for (std::vector<kernels::Feature>& kind : features.of_kind)
    round_all(
        kind,
        [quantum, first_quantum](kernels::Feature& feature) {
          round_feature(feature, quantum, first_quantum);
        },
        workers);
  for (kernels::SampledContours& contours : features.contours) {
    round_all(contours.points, round_position, workers);
    round_all(contours.torsion, round_number, workers);
  }
}

}  // namespace semigeo::jobs
