#include "jobs/bench/comparison.hpp"

#include <algorithm>

namespace semigeo::jobs {
namespace {

/// From this ratio on, CPU time counts as the same.
constexpr double kAsMuch = 0.9;

const NamedRate* find(std::span<const NamedRate> rates, const std::string& name) {
  const auto at = std::ranges::find(rates, name, &NamedRate::name);
  return at == rates.end() ? nullptr : &*at;
}

}  // namespace

const char* ComparedRate::verdict() const {
  if (!is_beyond_spread()) return "within spread";
  if (now.median >= before.median) return "faster";
  return is_disturbed(kAsMuch) ? "disturbed" : "slower";
}

Comparison compare(std::span<const NamedRate> before, std::span<const NamedRate> now) {
  Comparison comparison;
  for (const NamedRate& rate : now) {
    const NamedRate* old = find(before, rate.name);
    if (old == nullptr || old->unit != rate.unit) {
      comparison.only_now.push_back(rate.name);
      continue;
    }
    const bool known = old->cpu_rate > 0 && rate.cpu_rate > 0;
    comparison.rates.push_back({.name = rate.name,
                                .unit = rate.unit,
                                .before = old->rate,
                                .now = rate.rate,
                                .cpu_ratio = known ? rate.cpu_rate / old->cpu_rate : 1,
                                .disturbed = rate.disturbed});
  }
  for (const NamedRate& rate : before)
    if (find(now, rate.name) == nullptr) comparison.only_then.push_back(rate.name);
  return comparison;
}

bool is_of_machine(const std::string& name) {
  return name.starts_with("machine/");
}

std::vector<ComparedRate> fallen(const Comparison& comparison, double bound) {
  std::vector<ComparedRate> result;
  for (const ComparedRate& rate : comparison.rates)
    if (!is_of_machine(rate.name) && rate.fell_below(bound)) result.push_back(rate);
  return result;
}

}  // namespace semigeo::jobs
