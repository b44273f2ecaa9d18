#include "io/files/byte_source.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/io/scans/scan_files.hpp"

namespace semigeo::io {
namespace {

class ByteSourceTest : public ::testing::Test {
 protected:
  std::filesystem::path write(std::string_view name, std::string_view bytes) {
    return write_file(folder_ / std::string(name), bytes);
  }
  tests::TemporaryFolder folder_;
};

std::string some_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  std::uint32_t state = 1;
  for (char& c : bytes) c = static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
  return bytes;
}

/// Everything, in steps that do not divide the window.
std::string read_all(ByteSource& source) {
  std::string all;
  while (source.fill(1)) {
    const std::string_view ahead = source.ahead();
    const std::size_t step = std::min<std::size_t>(ahead.size(), 70'001);
    all += ahead.substr(0, step);
    source.consume(step);
    EXPECT_EQ(source.position(), static_cast<std::int64_t>(all.size()));
  }
  return all;
}

std::string error_of(const std::filesystem::path& path) {
  try {
    ByteSource source(path);
    read_all(source);
  } catch (const Error& failure) {
    return failure.what();
  }
  ADD_FAILURE() << path << " was read";
  return {};
}

TEST_F(ByteSourceTest, ReadsPlainFilesOfAnySize) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, std::size_t{2}, ByteSource::kWindowBytes - 1,
        ByteSource::kWindowBytes, ByteSource::kWindowBytes + 1, std::size_t{2'500'000}}) {
    const std::string bytes = some_bytes(size);
    ByteSource source(write("plain", bytes));
    EXPECT_EQ(source.compression(), "");
    EXPECT_EQ(source.bytes_left(), static_cast<std::int64_t>(size));
    EXPECT_TRUE(read_all(source) == bytes);
    EXPECT_EQ(source.bytes_left(), 0);
  }
}

TEST_F(ByteSourceTest, FillsAcrossTheWindow) {
  const std::string bytes = some_bytes(2'500'000);
  ByteSource source(write("plain", bytes));
  ASSERT_EQ(source.skip(1'000'000), 1'000'000);
  ASSERT_TRUE(source.fill(ByteSource::kWindowBytes));
  EXPECT_TRUE(source.ahead() == std::string_view(bytes).substr(1'000'000, source.ahead().size()));
  EXPECT_EQ(source.skip(1'499'999), 1'499'999);
  EXPECT_FALSE(source.fill(2));
  EXPECT_TRUE(source.fill(1));
  EXPECT_EQ(source.skip(5), 1);
  EXPECT_EQ(source.position(), 2'500'000);
}

TEST_F(ByteSourceTest, DecompressesWhateverTheName) {
  const std::string bytes = some_bytes(1'000'000) + std::string(5'000'000, 'x');
  ByteSource source(write("packed.ply", gzip(bytes)));
  EXPECT_EQ(source.compression(), "gzip");
  EXPECT_EQ(source.bytes_left(), std::nullopt);
  EXPECT_TRUE(read_all(source) == bytes);
}

TEST_F(ByteSourceTest, JoinsMembersAndSkipsPadding) {
  const std::string file =
      gzip("one, ") + gzip("") + std::string(100, '\0') + gzip("two") + std::string(200'000, '\0');
  ByteSource source(write("packed", file));
  EXPECT_EQ(read_all(source), "one, two");
}

TEST_F(ByteSourceTest, RefusesDamagedGzip) {
  const std::string bytes = some_bytes(300'000);
  const std::string whole = gzip(bytes);
  for (const std::size_t size : {std::size_t{2}, std::size_t{5}, std::size_t{18}, whole.size() / 2,
                                 whole.size() - 8, whole.size() - 1})
    expect_parts(error_of(write("cut.gz", whole.substr(0, size))),
                 {"byte " + std::to_string(size), "ends in the middle of its gzip data"});
  for (const std::size_t place :
       {std::size_t{2}, std::size_t{10}, whole.size() - 8, whole.size() - 4}) {
    std::string damaged = whole;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x55);
    expect_parts(error_of(write("damaged.gz", damaged)), {"byte ", "the gzip data is damaged"});
  }
  expect_parts(error_of(write("more.gz", whole + "garbage")),
               {"byte " + std::to_string(whole.size()), "other bytes after the end"});
  expect_parts(error_of(write("more.gz", whole + "\x1f")), {"ends in the middle"});
}

TEST_F(ByteSourceTest, SaysWhyAFileCannotBeOpened) {
  expect_parts(error_of(folder_ / "missing"), {"missing: there is no such file"});
  expect_parts(error_of(folder_.path()), {"is a folder"});
  expect_parts(error_of("/dev/null"), {"not a regular file"});
  const std::string name = folder_ / "socket";
  sockaddr_un address = {.sun_family = AF_UNIX, .sun_path = {}};
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  expect_parts(error_of(name), {"not a regular file", "copy its contents"});
  close(socket);
}

}  // namespace
}  // namespace semigeo::io
