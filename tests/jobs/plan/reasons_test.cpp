#include "jobs/plan/reasons.hpp"

#include <gtest/gtest.h>

#include <set>

namespace semigeo::jobs {
namespace {

using namespace nlohmann::literals;
using Kind = Reason::Kind;
using Reasons = std::vector<Reason>;

TEST(ReasonsTest, EveryKindHasANameAndWordsOfItsOwn) {
  std::set<std::string_view> names;
  std::set<std::string> words;
  std::set<std::string> short_words;
  for (int kind = 0; kind <= static_cast<int>(Kind::kDamagedSidecar); ++kind) {
    const Reason reason{.kind = Kind(kind), .parameter = "levels", .before = "8", .now = "20"};
    EXPECT_TRUE(names.insert(name_of(reason.kind)).second) << kind;
    EXPECT_TRUE(words.insert(in_words(reason)).second ||
                reason.kind == Kind::kDamagedArrays)  // says the same of a dataset
        << kind;
    EXPECT_TRUE(short_words.insert(in_short({reason})).second) << kind;
  }
}

TEST(ReasonsTest, ChangesAreListed) {
  const Reason scan{.kind = Kind::kScan, .before = "1", .now = "2"};
  const Reason levels{.kind = Kind::kParameter, .parameter = "levels", .before = 8, .now = 20};
  const Reason step{.kind = Kind::kParameter, .parameter = "step", .now = 1.0};
  const Reason program{.kind = Kind::kProgram, .before = "0.1.0"};
  EXPECT_EQ(in_short({}), "");
  EXPECT_EQ(in_short({levels, step}), "the parameters changed");
  EXPECT_EQ(in_short({scan, levels}), "the scan and the parameters changed");
  EXPECT_EQ(in_short({program, scan, step}), "the scan, the parameters and the program changed");
  EXPECT_EQ(in_words(levels), "parameter levels: 8, now 20");
  EXPECT_EQ(in_words(step), "parameter step: none, now 1.0");
}

TEST(ReasonsTest, ParametersAreComparedByName) {
  EXPECT_EQ(parameter_differences(R"({"a":1,"b":"x","gone":true,"same":0.5})"_json,
                                  R"({"a":2,"b":"y","new":7,"same":0.5})"_json),
            (Reasons{{.kind = Kind::kParameter, .parameter = "a", .before = 1, .now = 2},
                     {.kind = Kind::kParameter, .parameter = "b", .before = "x", .now = "y"},
                     {.kind = Kind::kParameter, .parameter = "gone", .before = true},
                     {.kind = Kind::kParameter, .parameter = "new", .now = 7}}));
  EXPECT_EQ(parameter_differences("{}"_json, "{}"_json), Reasons{});
  EXPECT_EQ(parameter_differences("nonsense", R"({"a":1})"_json),
            (Reasons{{.kind = Kind::kParameter, .parameter = "a", .now = 1}}));
  EXPECT_EQ(parameter_differences("[1]"_json, 7), Reasons{});
  EXPECT_EQ(parameter_differences(R"({"step":1})"_json, R"({"step":1.0})"_json).size(), 1u);
}

}  // namespace
}  // namespace semigeo::jobs
