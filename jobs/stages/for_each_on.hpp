#pragma once

#include <cstdint>

#include "engine/parallel.hpp"
#include "io/hdf5/for_each.hpp"

namespace semigeo::jobs {

/// Returns a loop whose turns run on the workers, for readers and writers, which know no workers.
inline io::ForEach for_each_on(engine::Workers& workers) {
  return [&workers](std::int64_t count, const auto& body) {
    workers.for_blocks(count, 1, [&](engine::IndexRange range) {
      for (auto i = range.begin; i < range.end; ++i) body(i);
    });
  };
}

}  // namespace semigeo::jobs
