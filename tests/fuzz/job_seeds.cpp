#include "jobs/kinds/all_kinds.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/kinds/report.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/run/job_line.hpp"
#include "jobs/slurm/task_list.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/surface_job.hpp"
#include "jobs/stages/triplets_job.hpp"
#include "tests/fuzz/seed_folder.hpp"

namespace semigeo::fuzz {
namespace {

using jobs::JobReply;
using jobs::JobRequest;

/// Writes a request for a job of a kind, its reply, and a list and results of one task.
void put_kind(const std::filesystem::path& folder, const jobs::JobKind& kind, std::any data,
              const std::any& result) {
  const std::string name = kind.words().kind;
  JobRequest request;
  request.job.kind = &kind;
  request.job.name = "a";
  request.job.input = "/in";
  request.job.output = "/out";
  request.job.key = "key";
  request.job.data = std::move(data);
  request.log = "/log";
  const std::string line = jobs::to_line(request);
  const JobReply reply = {.kind = JobReply::Kind::kDone, .result = kind.result_to_json(result)};
  put_seed(folder, "protocol", name + "_request", "d" + line);
  put_seed(folder, "protocol", name + "_reply", "e" + line + "\n" + jobs::to_line(reply));
  put_seed(folder, "protocol", name + "_task", "f" + jobs::task_list_text({}, {{request}}));
  jobs::TaskResults results;
  results[name].outcome.state = jobs::JobState::kDone;
  results[name].result = reply.result;
  put_seed(folder, "protocol", name + "_results", "g" + jobs::results_text(results));
}

}  // namespace

void make_job_seeds(const std::filesystem::path& folder) {
  put_kind(folder, jobs::surface_kind(), jobs::SurfaceJobData{}, jobs::SurfaceJobResult{});
  put_kind(folder, jobs::triplets_kind(), jobs::TripletsJobData{}, jobs::TripletsJobResult{});
  put_kind(folder, jobs::partition_kind(), jobs::PartitionJobData{.models = {"a", "b"}},
           jobs::PartitionJobResult{});
  put_kind(folder, jobs::library_kind(), jobs::LibraryJobData{.models = {"a", "b"}},
           jobs::LibraryJobResult{});
  put_kind(folder, jobs::recognise_kind(), jobs::RecogniseJobData{}, jobs::RecogniseJobResult{});
  put_kind(folder, jobs::page_kind(), jobs::PageJobData{}, {});
  put_kind(folder, jobs::scene_kind(), jobs::SceneJobData{}, {});
  put_kind(folder, jobs::report_kind(), jobs::ReportJobData{}, jobs::ReportJobResult{});
  const JobReply failed = {.error = "it failed", .write_error = 28};
  put_seed(folder, "protocol", "failed", "e{}\n" + jobs::to_line(failed));
  const JobReply worked = {.kind = JobReply::Kind::kWorked, .worked = 7};
  put_seed(folder, "protocol", "worked", "e{}\n" + jobs::to_line(worked));
  put_seed(folder, "protocol", "queue", "h0 RUNNING None\n1 PENDING Resources\n");
}

}  // namespace semigeo::fuzz
