#include "jobs/picture/colour_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "io/files/small_file.hpp"

namespace semigeo::jobs {
namespace {

TEST(ColourScaleTest, ValuesBeyondTheEndsHaveTheColoursOfTheEnds) {
  for (const ColourScale scale : {ColourScale::kSafe, ColourScale::kThesis}) {
    EXPECT_EQ(colour_of(scale, -7), colour_of(scale, -1));
    EXPECT_EQ(colour_of(scale, 7), colour_of(scale, 1));
    EXPECT_NE(colour_of(scale, -1), colour_of(scale, 1));
  }
  EXPECT_EQ(colour_of(ColourScale::kThesis, -1), (Colour{0, 0, 1}));
  EXPECT_EQ(colour_of(ColourScale::kThesis, 0), (Colour{0, 0.85f, 0}));
}

TEST(ColourScaleTest, ColoursBetweenStopsAreMixed) {
  EXPECT_FLOAT_EQ(colour_of(ColourScale::kThesis, 0.75f)[1], 0.5f);
  EXPECT_EQ(colour_of(ColourScale::kSafe, std::numeric_limits<float>::quiet_NaN()), kInvalidColour);
}

TEST(ColourScaleTest, PagesOfTheReportHaveTheSameColours) {
  const std::string source = io::read_text(SEMIGEO_SOURCE "/report/src/colours.ts", {});
  const auto numbers_behind = [&](const std::string& name) {
    std::vector<float> numbers;
    const std::size_t begin = source.find(name);
    EXPECT_NE(begin, std::string::npos) << name;
    const std::string line = source.substr(begin, source.find('\n', begin) - begin);
    const std::regex number("[0-9]+(\\.[0-9]+)?");
    for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at)
      numbers.push_back(std::stof(at->str()));
    return numbers;
  };
  for (std::size_t scale = 0; scale < kColourScaleNames.size(); ++scale) {
    std::vector<float> ours;
    for (const float value : {-1.0f, -0.5f, 0.0f, 0.5f, 1.0f})
      for (const float part : colour_of(static_cast<ColourScale>(scale), value))
        ours.push_back(part);
    const std::vector<float> theirs = numbers_behind(std::string(kColourScaleNames[scale]) + ": [");
    ASSERT_EQ(theirs.size(), ours.size());
    for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(theirs[i], ours[i], 1e-6f);
  }
  EXPECT_EQ(numbers_behind("invalidColour: Colour = "),
            std::vector<float>(kInvalidColour.begin(), kInvalidColour.end()));
  EXPECT_EQ(numbers_behind("plainColour: Colour = "),
            std::vector<float>(kPlainColour.begin(), kPlainColour.end()));
}

TEST(ColourScaleTest, EveryChannelHasAByte) {
  EXPECT_EQ(channel_byte(0.5f), 128);
  EXPECT_EQ(channel_byte(2), 255);
  EXPECT_EQ(channel_byte(-1), 0);
  EXPECT_EQ(channel_byte(std::numeric_limits<float>::quiet_NaN()), 0);
}

}  // namespace
}  // namespace semigeo::jobs
