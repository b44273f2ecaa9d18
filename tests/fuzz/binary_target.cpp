// A run of triplets, or if SEMIGEO_FUZZ_PARTITION is defined, a partition of postings. All
// checksums are made right again, so that what is behind them is reached.
#include <cstring>
#include <span>
#include <vector>

#include "io/files/chunk_codec.hpp"
#include "io/files/error.hpp"
#include "io/library/hash_library_format.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "tests/fuzz/target.hpp"

namespace semigeo::fuzz {
namespace {

constexpr std::size_t kStartBytes = 12;    // magic and version
constexpr std::size_t kTrailerBytes = 24;  // size and hash of the head, hash of these

std::uint64_t hash_of(std::string_view bytes) {
  return io::xxh3_64(std::as_bytes(std::span(bytes)));
}

template <typename Number>
Number number_at(std::string_view bytes, std::size_t at) {
  Number number = 0;
  if (at + sizeof number <= bytes.size()) std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

void put(std::string& bytes, std::size_t at, std::uint64_t number) {
  if (at + sizeof number <= bytes.size()) std::memcpy(bytes.data() + at, &number, sizeof number);
}

#ifdef SEMIGEO_FUZZ_PARTITION

constexpr std::string_view kMagic = "semigeoP";

/// Makes the hashes of the blocks right, which end the head.
void mend_head(std::string& head, std::string_view data) {
  constexpr std::size_t kBlockBytes = io::kBlockPostings * io::kPostingBytes;
  const std::size_t blocks = (data.size() + kBlockBytes - 1) / kBlockBytes;
  if (head.size() < 8 * blocks) return;
  for (std::size_t block = 0; block < blocks; ++block)
    put(head, head.size() - 8 * (blocks - block),
        hash_of(data.substr(block * kBlockBytes, kBlockBytes)));
}

void read(const std::filesystem::path& path) {
  const io::PostingPartition partition(path);
  std::int64_t bytes = 0;
  for (std::int64_t block = 0; block < partition.blocks(); ++block)
    bytes += static_cast<std::int64_t>(partition.read_block(block).size());
  check(bytes == partition.postings() * static_cast<std::int64_t>(io::kPostingBytes),
        "there are not as many postings as are told");
  check(io::posting_partition_key(path) == partition.header().job_key, "the key is another");
}

#else

constexpr std::string_view kMagic = "semigeoT";

/// Makes the hashes of the shapes and of the model right, which end the head.
void mend_head(std::string& head, std::string_view data) {
  using kernels::kShapes;
  constexpr std::size_t kRowBytes = 24;
  constexpr std::size_t kHashes = 8 * (kShapes + 1);
  constexpr std::size_t kOffsets = 4 * (kShapes + 1);
  if (head.size() < kHashes + kOffsets) return;
  const std::size_t hashes = head.size() - kHashes;
  std::size_t begin = 0;
  for (std::size_t shape = 0; shape < kShapes; ++shape) {
    const std::size_t end =
        kRowBytes * number_at<std::uint32_t>(head, hashes - kOffsets + 4 * (shape + 1));
    if (end < begin || end > data.size()) return;
    put(head, hashes + 8 * shape, hash_of(data.substr(begin, end - begin)));
    begin = end;
  }
  put(head, hashes + 8 * kShapes, hash_of(data.substr(begin)));
}

void read(const std::filesystem::path& path) {
  const io::TripletRun run(path);
  const std::vector<kernels::Triplet> triplets = run.read_triplets();
  check(std::ssize(triplets) == run.triplets(), "there are not as many triplets as are told");
  for (const kernels::Triplet& triplet : triplets)
    for (const std::uint16_t corner : triplet.corners)
      check(corner < run.features(), "a corner does not exist");
  const kernels::RecognitionModel model = run.read_model();
  check(std::ssize(model.features.features) == run.features(), "features are missing");
  for (const kernels::OrientedFeature& feature : model.features.features)
    check(feature.level < run.levels(), "a feature is of no level");
  check(io::triplet_run_key(path) == run.job_key(), "the key is another");
}

#endif

void mend(std::string& bytes) {
  if (bytes.size() < kStartBytes + kTrailerBytes) return;
  bytes.replace(0, kMagic.size(), kMagic);
  bytes.replace(kMagic.size(), 4, std::string("\1\0\0\0", 4));
  const std::size_t trailer = bytes.size() - kTrailerBytes;
  const auto head_bytes = number_at<std::uint64_t>(bytes, trailer);
  if (head_bytes <= trailer - kStartBytes) {
    const std::size_t begin = trailer - head_bytes;
    std::string head = bytes.substr(begin, head_bytes);
    mend_head(head, std::string_view(bytes).substr(kStartBytes, begin - kStartBytes));
    bytes.replace(begin, head_bytes, head);
    put(bytes, trailer + 8, hash_of(head));
  }
  put(bytes, trailer + 16, hash_of(std::string_view(bytes).substr(trailer, 16)));
}

}  // namespace

void read_input(std::string_view bytes) {
  std::string mended(bytes);
  mend(mended);
  const std::filesystem::path path = write("file", mended);
  try {
    read(path);
  } catch (const io::Error& error) {
    check(error.file() == path, "an error names another file");
  }
}

}  // namespace semigeo::fuzz
