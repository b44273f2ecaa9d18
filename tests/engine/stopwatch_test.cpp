#include "engine/stopwatch.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

namespace semigeo::engine {
namespace {

struct Record : Observer {
  void timed(std::string_view stretch, double seconds, double cpu_seconds) override {
    stretches.push_back({std::string(stretch), seconds, cpu_seconds});
  }
  struct Stretch {
    std::string name;
    double seconds, cpu_seconds;
  };
  std::vector<Stretch> stretches;
};

TEST(Stopwatch, TellsOnceAtTheEndOfItsScope) {
  Record record;
  {
    const Stopwatch outer(record, "outer");
    { const Stopwatch inner(record, "inner"); }
    EXPECT_EQ(record.stretches.size(), 1u);
  }
  ASSERT_EQ(record.stretches.size(), 2u);
  const auto& [inner, outer] = std::tie(record.stretches[0], record.stretches[1]);
  EXPECT_EQ(inner.name, "inner");
  EXPECT_EQ(outer.name, "outer");
  EXPECT_GE(inner.seconds, 0);
  EXPECT_GE(outer.seconds, inner.seconds);
  EXPECT_GE(inner.cpu_seconds, 0);
  EXPECT_GE(outer.cpu_seconds, inner.cpu_seconds);
}

}  // namespace
}  // namespace semigeo::engine
