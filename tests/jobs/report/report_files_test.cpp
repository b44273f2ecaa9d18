#include "jobs/report/report_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "io/files/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

TEST(ReportFilesTest, APageKeepsItsKey) {
  const tests::TemporaryFolder folder;
  const std::string key = page_key("1", {"<a>", "</a>"}, "content");
  write_page(folder / "a.html", key, "<a></a>");
  EXPECT_EQ(read_page_key(folder / "a.html"), key);
}

TEST(ReportFilesTest, AKeyChangesWithVersionPageAndContent) {
  std::set<std::string> keys = {page_key("1", {"<a>", "</a>"}, "content")};
  EXPECT_TRUE(keys.insert(page_key("2", {"<a>", "</a>"}, "content")).second);
  EXPECT_TRUE(keys.insert(page_key("1", {"<b>", "</a>"}, "content")).second);
  EXPECT_TRUE(keys.insert(page_key("1", {"<a>", "</b>"}, "content")).second);
  EXPECT_TRUE(keys.insert(page_key("1", {"<a>", "</a>"}, "other")).second);
  EXPECT_FALSE(keys.insert(page_key("1", {"<a>", "</a>"}, "content")).second);
}

TEST(ReportFilesTest, WhatIsNoPageHasNoKey) {
  const tests::TemporaryFolder folder;
  std::ofstream(folder / "a.html")
      << "<!DOCTYPE html>\n<p>A page of somebody else, long enough.</p>\n";
  std::ofstream(folder / "empty.html") << "";
  EXPECT_THROW(read_page_key(folder / "a.html"), io::Error);
  EXPECT_THROW(read_page_key(folder / "empty.html"), io::Error);
  EXPECT_THROW(read_page_key(folder / "absent.html"), io::Error);
}

TEST(ReportFilesTest, JobsThatMakePagesAreKnownByTheirKinds) {
  EXPECT_TRUE(makes_page("page a.ply"));
  EXPECT_TRUE(makes_page("scene a.ply"));
  EXPECT_TRUE(makes_page("report index.html"));
  EXPECT_FALSE(makes_page("surface page"));
}

}  // namespace
}  // namespace semigeo::jobs
