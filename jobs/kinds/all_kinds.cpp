#include "jobs/kinds/all_kinds.hpp"

#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/kinds/report.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"

namespace semigeo::jobs {

const JobKinds& all_kinds() {
  static const JobKinds kinds({&surface_kind(), &triplets_kind(), &partition_kind(),
                               &library_kind(), &recognise_kind(), &page_kind(), &scene_kind(),
                               &report_kind()});
  return kinds;
}

}  // namespace semigeo::jobs
