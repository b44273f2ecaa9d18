// Whatever the bytes are, a reader returns a valid mesh or throws Error: no crash, no other
// exception, no endless loop, and no memory that the bytes cannot account for.
#include <cmath>
#include <cstdlib>
#include <new>
#include <ostream>
#include <random>

#include "tests/io/scans/scan_files.hpp"
#include "tests/io/scans/scan_seeds.hpp"

namespace {
// Far above what files of some kilobytes need (the window takes 1 MiB), far below what the numbers
// in them can promise.
constexpr std::size_t kLargestAllocation = std::size_t{16} << 20;
}  // namespace

// Not inlined, or the compiler takes the pairs of new and free for mistakes.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  if (bytes > kLargestAllocation) throw std::bad_alloc();
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace semigeo::io {
namespace {

constexpr int kMutants = 3000;

std::vector<Seed> seeds() {
  std::vector<Seed> all = plain_seeds();
  for (const std::size_t packed : {3, 7})
    all.push_back({all[packed].name + ".gz", gzip(all[packed].bytes)});
  return all;
}

class Mutator {
 public:
  explicit Mutator(unsigned seed) : random_(seed) {}

  std::string mutate(std::string bytes) {
    for (std::size_t edits = 1 + below(4); edits > 0 && !bytes.empty(); --edits) edit(bytes);
    return bytes;
  }

 private:
  std::size_t below(std::size_t limit) { return random_() % limit; }
  char byte() { return static_cast<char>(random_()); }

  void edit(std::string& bytes) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(64, bytes.size() - at));
    switch (below(9)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes[at] = byte();
        break;
      case 2:
        bytes.resize(at);
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 5:
        bytes.insert(at, 1, byte());
        break;
      case 6:
        replace_number(bytes, at);
        break;
      case 7:
        replace_word(bytes, at);
        break;
      default:
        bytes[at] = " \n\r\t#\\-/.eE0\0"[below(13)];
    }
  }

  /// Four or eight bytes become a number that binary formats may stumble over.
  void replace_word(std::string& bytes, std::size_t at) {
    constexpr std::uint32_t kNasty[] = {0,          1,          0xffffffff, 0x7fffffff, 0x80000000,
                                        0x7fc00000, 0x7f800000, 0x7f7fffff, 0x00ffffff, 65'536};
    const std::endian order = below(2) == 0 ? std::endian::little : std::endian::big;
    const std::string word = bytes_of(kNasty[below(std::size(kNasty))], order);
    bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at), word);
  }

  /// The next run of digits becomes a number that text formats may stumble over.
  void replace_number(std::string& bytes, std::size_t at) {
    const char* const nasty[] = {"-1",  "0",   "2147483647", "2147483648", "9223372036854775807",
                                 "nan", "inf", "1e999",      "-1e-999",    "99999999999999999999",
                                 "",    "1e",  "70000",      "1000000000", "-9223372036854775808"};
    const std::size_t first = bytes.find_first_of("0123456789", at);
    if (first == std::string::npos) return;
    const std::size_t last = std::min(bytes.find_first_not_of("0123456789", first), bytes.size());
    bytes.replace(first, last - first, nasty[below(std::size(nasty))]);
  }

  std::mt19937 random_;
};

void expect_valid(const Scan& scan) {
  ASSERT_FALSE(scan.mesh.points.empty());
  ASSERT_FALSE(scan.mesh.triangles.empty());
  for (const Eigen::Vector3d& p : scan.mesh.points) ASSERT_TRUE(p.allFinite());
  const auto count = static_cast<std::int64_t>(scan.mesh.points.size());
  for (const auto& triangle : scan.mesh.triangles)
    for (const std::int64_t corner : triangle) ASSERT_TRUE(corner >= 0 && corner < count);
}

class ScanReaderFuzz : public ::testing::TestWithParam<Seed> {};
class GzipFuzz : public ::testing::TestWithParam<Seed> {};

std::string test_name(const ::testing::TestParamInfo<Seed>& test) {
  std::string name = test.param.name;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

/// Reads the bytes; true if they were a scan.
bool survives(const std::filesystem::path& path, const std::string& bytes) {
  write_file(path, bytes);
  try {
    expect_valid(read_scan(path));
    return true;
  } catch (const Error& failure) {
    EXPECT_EQ(failure.file(), path);
    EXPECT_FALSE(failure.problem().empty());
    return false;
  }
}

TEST_P(ScanReaderFuzz, ReturnsAMeshOrThrowsError) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path path = folder / GetParam().name;
  ASSERT_TRUE(survives(path, GetParam().bytes));
  Mutator mutator(20'011);
  int read = 0;
  for (int i = 0; i < kMutants && !HasFailure(); ++i) {
    SCOPED_TRACE("mutant " + std::to_string(i));
    read += survives(path, mutator.mutate(GetParam().bytes)) ? 1 : 0;
  }
  EXPECT_LT(read, kMutants);
}

/// What the checksum would keep from the reader behind the decompression.
TEST_P(GzipFuzz, SurvivesDamageInside) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path path = folder / (GetParam().name + ".gz");
  Mutator mutator(7);
  for (int i = 0; i < kMutants / 10 && !HasFailure(); ++i) {
    SCOPED_TRACE("mutant " + std::to_string(i));
    survives(path, gzip(mutator.mutate(GetParam().bytes)));
  }
}

TEST_P(ScanReaderFuzz, SurvivesEveryCut) {
  const tests::TemporaryFolder folder;
  const std::string& bytes = GetParam().bytes;
  for (std::size_t size = 0; size < bytes.size() && !HasFailure(); ++size) {
    SCOPED_TRACE("cut after byte " + std::to_string(size));
    survives(folder / GetParam().name, bytes.substr(0, size));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ScanReaderFuzz, ::testing::ValuesIn(seeds()), test_name);
INSTANTIATE_TEST_SUITE_P(Seeds, GzipFuzz, ::testing::ValuesIn(plain_seeds()), test_name);

}  // namespace
}  // namespace semigeo::io
