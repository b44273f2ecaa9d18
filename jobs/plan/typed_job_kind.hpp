#pragma once

#include <any>
#include <nlohmann/json.hpp>
#include <utility>

#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {

/// A kind whose jobs carry a `Data` and give a `Result`. Both are default-constructible, copyable
/// structs with functions `to_json(nlohmann::json&, const T&)` and
/// `from_json(const nlohmann::json&, T&)` beside them.
template <typename Data, typename Result>
class TypedJobKind : public JobKind {
 public:
  static const Data& data(const Job& job) { return std::any_cast<const Data&>(job.data); }
  static Data& data(Job& job) { return std::any_cast<Data&>(job.data); }
  /// Returns null for an empty result.
  static const Result* result(const std::any& value) { return std::any_cast<Result>(&value); }

  nlohmann::json data_to_json(const Job& job) const final { return data(job); }
  std::any data_from_json(const nlohmann::json& object) const final { return object.get<Data>(); }
  nlohmann::json result_to_json(const std::any& value) const final {
    return value.has_value() ? nlohmann::json(*result(value)) : nlohmann::json();
  }
  std::any result_from_json(const nlohmann::json& object) const final {
    return object.is_null() ? std::any() : std::any(object.get<Result>());
  }
};

}  // namespace semigeo::jobs
