#include "engine/stopwatch.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace semigeo::engine {
namespace {

struct Record : Observer {
  void timed(std::string_view stretch, double seconds) override {
    stretches.emplace_back(stretch, seconds);
  }
  std::vector<std::pair<std::string, double>> stretches;
};

TEST(Stopwatch, TellsOnceAtTheEndOfItsScope) {
  Record record;
  {
    const Stopwatch outer(record, "outer");
    { const Stopwatch inner(record, "inner"); }
    EXPECT_EQ(record.stretches.size(), 1u);
  }
  ASSERT_EQ(record.stretches.size(), 2u);
  EXPECT_EQ(record.stretches[0].first, "inner");
  EXPECT_EQ(record.stretches[1].first, "outer");
  EXPECT_GE(record.stretches[0].second, 0);
  EXPECT_GE(record.stretches[1].second, record.stretches[0].second);
}

}  // namespace
}  // namespace semigeo::engine
