#include "kernels/lanes/instruction_set.hpp"

#include <gtest/gtest.h>

namespace semigeo::kernels {
namespace {

TEST(InstructionSetTest, NamesAreReadAsTheyAreWritten) {
  for (const InstructionSet set : kInstructionSets)
    EXPECT_EQ(instruction_set_named(name_of(set)), set);
  EXPECT_EQ(instruction_set_named("avx512f"), std::nullopt);
  EXPECT_EQ(instruction_set_named(""), std::nullopt);
}

TEST(InstructionSetTest, TheBestOneIsSupportedAndNoBetterOneIs) {
  const InstructionSet best = best_instruction_set();
  EXPECT_TRUE(supported(best));
  EXPECT_TRUE(supported(InstructionSet::kScalar));
  EXPECT_TRUE(supported(InstructionSet::kBaseline));
#if defined(__x86_64__)
  for (const InstructionSet set : kInstructionSets)
    if (set > best) EXPECT_FALSE(supported(set));
#endif
}

}  // namespace
}  // namespace semigeo::kernels
