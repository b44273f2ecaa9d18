#include "jobs/report/page.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

TEST(PageTest, HasItsDataBetweenItsHalves) {
  EXPECT_EQ(page_with({"<a>", "</a>"}, {{"n", 1}}), "<a>{\"n\":1}</a>");
}

TEST(PageTest, NoTextOfTheDataIsMarkup) {
  const nlohmann::json data = {{"</script><img src=x onerror=alert(1)>", "<!--<script>"}};
  const std::string page = page_with({"", ""}, data);
  EXPECT_EQ(page.find('<'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(page), data);
}

TEST(PageTest, BytesThatAreNoTextAreReplaced) {
  EXPECT_EQ(page_with({"", ""}, "a\xff z"), "\"a\xef\xbf\xbd z\"");
}

TEST(PageTest, ItsDataCanBeReadAgain) {
  const tests::TemporaryFolder folder;
  const PageTemplate page = {"<a>", "</a>"};
  const nlohmann::json data = {{"scans", {"</a>", "<a>"}}};
  std::ofstream(folder / "p.html") << "<!-- a line before it -->\n" << page_with(page, data);
  EXPECT_EQ(read_page_data(folder / "p.html", page), data);
  EXPECT_TRUE(read_page_data(folder / "p.html", {"<b>", "</b>"}).is_null());
  EXPECT_TRUE(read_page_data(folder / "none.html", page).is_null());
}

}  // namespace
}  // namespace semigeo::jobs
