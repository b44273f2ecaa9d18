#include "jobs/kinds/report_plan.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "io/files/error.hpp"
#include "jobs/archive/sources.hpp"
#include "jobs/kinds/recognise_plan.hpp"
#include "jobs/kinds/report.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/report/archive_report.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/pages.hpp"
#include "jobs/report/report_files.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

PlannedJob page_of(const LibraryModel& dataset, const fs::path& folder) {
  PlannedJob planned;
  planned.job = page_job(dataset.name, dataset.dataset, dataset.dataset_key, folder);
  if (dataset.maker) planned.after = {*dataset.maker};
  planned.inputs_are_there = !dataset.maker;
  judge_output(planned, KeyCheck::kHead);
  return planned;
}

/// Plans the page of a scene. A model in it may be made again, so it waits for the datasets.
PlannedJob page_of_scene(const std::string& name, const fs::path& scene, const ReportPlace& place,
                         const std::vector<PlannedJob>& plan) {
  PlannedJob planned;
  for (std::size_t i = 0; i < plan.size(); ++i)
    if (plan[i].job.kind == &surface_kind() && !plan[i].up_to_date) planned.after.push_back(i);
  try {
    planned.job = scene_job(name, scene, place.archive, place.folder);
    judge_output(planned, KeyCheck::kHead);
  } catch (const io::Error& error) {
    planned.job = {.kind = &scene_kind(),
                   .name = name,
                   .input = recognised_path(place.archive, name),
                   .output = scene_page_path(place.folder, name),
                   .key = ""};
    planned.error = error.what();
  }
  return planned;
}

/// Plans the first page. It is up to date only if no other job runs.
PlannedJob first_page(const ReportPlace& place, const std::vector<PlannedJob>& plan) {
  PlannedJob planned;
  planned.job = report_job(place.archive, place.folder, place.index_only);
  planned.after.resize(plan.size());
  std::iota(planned.after.begin(), planned.after.end(), std::size_t{0});
  if (std::ranges::all_of(plan, &PlannedJob::up_to_date))
    planned.job.key =
        page_key(kIndexVersion, pages().index, archive_digest(place.archive, place.folder));
  judge_output(planned, KeyCheck::kHead);
  return planned;
}

}  // namespace

fs::path report_folder(const fs::path& archive) {
  return archive / "report";
}

void plan_report(std::vector<PlannedJob>& plan, const std::vector<LibraryModel>& datasets,
                 const ReportPlace& place) {
  if (!place.index_only) {
    // What cannot be read is reported once, as the failure of its own job or on the first page.
    for (const LibraryModel& dataset : datasets)
      if (dataset.error.empty()) plan.push_back(page_of(dataset, place.folder));
    const Sources scenes = Sources::read(recognised_folder(place.archive));
    for (const std::string& name : scene_names(place.archive)) {
      const auto scene = scenes.by_name().find(name);
      plan.push_back(page_of_scene(
          name, scene == scenes.by_name().end() ? fs::path() : scene->second, place, plan));
    }
  }
  plan.push_back(first_page(place, plan));
}

}  // namespace semigeo::jobs
