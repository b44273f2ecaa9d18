#include "io/files/line_reader.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

class LineReaderTest : public testing::Test {
 protected:
  std::vector<std::string> lines_of(const std::string& text, std::size_t longest = 1 << 20) {
    const auto file = folder_ / "lines";
    std::ofstream(file, std::ios::binary) << text;
    LineReader reader(file, longest);
    std::vector<std::string> lines;
    for (std::string line; reader.next(line);) lines.push_back(line);
    return lines;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(LineReaderTest, LinesComeOneByOne) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines_of(""), Lines());
  EXPECT_EQ(lines_of("\n"), Lines({""}));
  EXPECT_EQ(lines_of("a\n\nb"), Lines({"a", "", "b"}));
  EXPECT_EQ(lines_of("a\nb\n"), Lines({"a", "b"}));
}

TEST_F(LineReaderTest, LinesMayBeLongerThanTheBuffer) {
  const std::string longer(200'000, 'x');
  EXPECT_EQ(lines_of(longer + "\n" + longer + "y"),
            std::vector<std::string>({longer, longer + "y"}));
}

TEST_F(LineReaderTest, ALineThatIsTooLongIsNamed) {
  EXPECT_EQ(lines_of("a\n12345678\n", 8).size(), 2u);
  try {
    lines_of("a\n123456789\n", 8);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 2"), std::string::npos) << error.what();
  }
}

TEST_F(LineReaderTest, APipeIsRefusedWithoutWaiting) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(LineReader reader(pipe), Error);
  EXPECT_THROW(LineReader reader(folder_ / "none"), ReadError);
}

}  // namespace
}  // namespace semigeo::io
