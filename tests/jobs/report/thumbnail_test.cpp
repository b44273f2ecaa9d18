#include "jobs/report/thumbnail.hpp"

#include <gtest/gtest.h>

#include "io/files/file_digest.hpp"
#include "jobs/report/page.hpp"
#include "jobs/report/report_files.hpp"
#include "jobs/stages/surface_job.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

TEST(ThumbnailTest, IsASmallPngAndTheIconOfAPage) {
  const tests::TemporaryFolder folder;
  const auto scan = tests::write_obj(folder / "scan.obj", shapes::icosphere(3));
  SurfaceJob job;
  job.input = scan;
  job.input_name = "scan.obj";
  job.output = folder / "scan.obj.vtkhdf";
  job.input_xxh3 = io::xxh3_of_file(scan);
  engine::Workers workers(1);
  engine::Observer observer;
  run_surface_job(job, {.levels = 2}, {workers, observer, {}});
  const std::string png = thumbnail_of(io::Dataset(job.output));
  EXPECT_TRUE(png.starts_with("\x89PNG"));
  EXPECT_GT(png.size(), 200u);
  EXPECT_LT(png.size(), 4000u);

  const std::string plain = "<link rel=\"icon\" href=\"data:,\">";
  write_page(folder / "plain.html", std::string(32, '0'), plain);
  EXPECT_EQ(read_icon(folder / "plain.html"), "");
  write_page(folder / "page.html", std::string(32, '0'), with_icon(plain, png));
  const std::string icon = read_icon(folder / "page.html");
  EXPECT_EQ(icon.size(), (png.size() + 2) / 3 * 4);
  EXPECT_TRUE(icon.starts_with("iVBOR"));  // the magic number of PNG
  EXPECT_EQ(read_icon(folder / "absent.html"), "");
}

}  // namespace
}  // namespace semigeo::jobs
