#include "jobs/report/page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

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

}  // namespace
}  // namespace semigeo::jobs
