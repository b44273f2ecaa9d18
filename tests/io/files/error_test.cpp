#include "io/files/error.hpp"

#include <gtest/gtest.h>

namespace semigeo::io {
namespace {

TEST(ErrorTest, WhatAFileHoldsDoesNotCutTheSentence) {
  const std::string quoted("unknown type 'a\0b\nc\rd'", 22);
  const Error error("a.ply", "line 4", quoted, "correct it");
  EXPECT_STREQ(error.what(), "a.ply: line 4: unknown type 'a\\x00b\\nc\\rd'; correct it");
  EXPECT_EQ(error.problem(), "unknown type 'a\\x00b\\nc\\rd'");
}

}  // namespace
}  // namespace semigeo::io
