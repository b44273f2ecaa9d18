#include "io/library/posting_partition.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <stdexcept>

#include "io/files/error.hpp"
#include "io/library/hash_library_format.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

std::string read_all(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_all(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class PostingPartitionTest : public testing::Test {
 protected:
  PostingPartitionTest() : counts_(3 * kernels::kCodeTriples) {}

  /// `postings` of them in the last cell, given in pieces of `piece`.
  void write(std::size_t postings, std::size_t piece) {
    rows_.resize(postings * kPostingBytes);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i] = static_cast<std::byte>(i * 2654435761U >> 24);
    counts_.back() = static_cast<std::uint32_t>(postings);
    PostingPartitionWriter writer(path_, header_);
    for (std::size_t at = 0; at < rows_.size(); at += piece * kPostingBytes)
      writer.add(std::span(rows_).subspan(at, std::min(piece * kPostingBytes, rows_.size() - at)));
    writer.finish(counts_);
  }
  std::vector<std::byte> read() const {
    const PostingPartition partition(path_);
    std::vector<std::byte> rows;
    for (std::int64_t i = 0; i < partition.blocks(); ++i) {
      const std::vector<std::byte> block = partition.read_block(i);
      rows.insert(rows.end(), block.begin(), block.end());
    }
    return rows;
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "partition";
  PartitionHeader header_{.job_key = "key", .shapes = {7, 10}, .models = 4, .runs_hash = 17};
  std::vector<std::uint32_t> counts_;
  std::vector<std::byte> rows_;
};

TEST_F(PostingPartitionTest, HoldsWhatWasWritten) {
  for (const std::size_t postings : {0, 1, 65536, 65537, 150000}) {
    write(postings, 70000);
    const PostingPartition partition(path_);
    EXPECT_EQ(partition.postings(), postings);
    EXPECT_EQ(partition.blocks(), (postings + 65535) / 65536);
    EXPECT_EQ(partition.header().job_key, "key");
    EXPECT_EQ(partition.header().shapes, header_.shapes);
    EXPECT_EQ(partition.header().models, 4);
    EXPECT_EQ(partition.header().runs_hash, 17U);
    EXPECT_TRUE(std::ranges::equal(partition.cell_counts(), counts_));
    EXPECT_EQ(read(), rows_);
  }
  EXPECT_EQ(posting_partition_key(path_), "key");
}

TEST_F(PostingPartitionTest, PiecesDoNotMatter) {
  write(150000, 150000);
  const std::string bytes = read_all(path_);
  for (const std::size_t piece : {1000, 65536, 100000}) {
    write(150000, piece);
    EXPECT_EQ(read_all(path_), bytes);
  }
}

TEST_F(PostingPartitionTest, DamageAnywhereIsNoticed) {
  write(100, 100);
  const std::string good = read_all(path_);
  for (std::size_t at = 0; at < good.size(); at += 13) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1 << at % 8);
    write_all(path_, bad);
    EXPECT_THROW(read(), Error) << "byte " << at;
  }
  for (std::size_t size = 0; size < good.size(); size += 111) {
    write_all(path_, good.substr(0, size));
    EXPECT_THROW(read(), Error) << size << " bytes";
  }
}

TEST_F(PostingPartitionTest, CountsMustFit) {
  PostingPartitionWriter writer(path_, header_);
  EXPECT_THROW(writer.add(std::vector<std::byte>(kPostingBytes + 1)), std::invalid_argument);
  writer.add(std::vector<std::byte>(kPostingBytes));
  EXPECT_THROW(writer.finish(counts_), std::invalid_argument);
  counts_[5] = 1;
  EXPECT_THROW(writer.finish(std::span(counts_).first(6)), std::invalid_argument);
  writer.finish(counts_);
  EXPECT_EQ(PostingPartition(path_).postings(), 1);
}

}  // namespace
}  // namespace semigeo::io
