#include "io/library/posting_partition.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "io/files/chunk_codec.hpp"
#include "io/library/hash_library_format.hpp"

namespace semigeo::io {
namespace {

constexpr BinaryFormat kPartitionFormat = {
    .magic = "semigeoP", .version = 1, .noun = "a partition of a library"};
constexpr std::size_t kBlockBytes = kBlockPostings * kPostingBytes;

std::uint64_t sum_of(std::span<const std::uint32_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

}  // namespace

std::uint64_t runs_hash(std::span<const std::uint64_t> content_hashes) {
  return xxh3_64(std::as_bytes(content_hashes));
}

PostingPartitionWriter::PostingPartitionWriter(const std::filesystem::path& path,
                                               PartitionHeader header)
    : header_(std::move(header)), file_(path, kPartitionFormat) {}

void PostingPartitionWriter::write_block(std::span<const std::byte> rows) {
  block_hashes_.push_back(xxh3_64(rows));
  file_.data(rows);
}

void PostingPartitionWriter::add(std::span<const std::byte> rows) {
  if (rows.size() % kPostingBytes != 0) throw std::invalid_argument("half a posting");
  postings_ += rows.size() / kPostingBytes;
  while (!rows.empty()) {
    const std::size_t missing = std::min(kBlockBytes - pending_.size(), rows.size());
    if (pending_.empty() && missing == kBlockBytes) {
      write_block(rows.first(missing));
    } else {
      pending_.insert(pending_.end(), rows.begin(),
                      rows.begin() + static_cast<std::ptrdiff_t>(missing));
      if (pending_.size() == kBlockBytes) {
        write_block(pending_);
        pending_.clear();
      }
    }
    rows = rows.subspan(missing);
  }
}

void PostingPartitionWriter::finish(std::span<const std::uint32_t> cell_counts) {
  if (cell_counts.size() != header_.shapes.end_cell() - header_.shapes.first_cell() ||
      sum_of(cell_counts) != postings_)
    throw std::invalid_argument("the cells have not as many postings as were added");
  if (!pending_.empty()) write_block(pending_);
  HeadWriter head;
  head.text(header_.job_key);
  head.number(static_cast<std::int32_t>(header_.shapes.first));
  head.number(static_cast<std::int32_t>(header_.shapes.end));
  head.number(header_.models);
  head.number(header_.runs_hash);
  head.numbers(cell_counts);
  head.numbers(std::span<const std::uint64_t>(block_hashes_));
  file_.finish_unsynced(head);
}

PostingPartition::PostingPartition(const std::filesystem::path& path)
    : file_(path, kPartitionFormat) {
  header_.job_key = file_.text();
  header_.shapes.first = file_.number<std::int32_t>();
  header_.shapes.end = file_.number<std::int32_t>();
  header_.models = file_.number<std::int64_t>();
  header_.runs_hash = file_.number<std::uint64_t>();
  const ShapeRange& shapes = header_.shapes;
  if (shapes.first < 0 || shapes.end < shapes.first || shapes.end > kernels::kShapes ||
      header_.models < 0)
    file_.refuse("head", "has shapes or models that do not exist");
  cell_counts_ = file_.numbers<std::uint32_t>(shapes.end_cell() - shapes.first_cell());
  postings_ = static_cast<std::int64_t>(sum_of(cell_counts_));
  block_hashes_ = file_.numbers<std::uint64_t>((postings_ + kBlockPostings - 1) / kBlockPostings);
  file_.end_of_head();
  if (file_.data_bytes() != static_cast<std::uint64_t>(postings_) * kPostingBytes)
    file_.refuse("", "has " + std::to_string(file_.data_bytes()) + " bytes of data instead of " +
                         std::to_string(postings_ * kPostingBytes));
}

std::vector<std::byte> PostingPartition::read_block(std::int64_t block) const {
  const std::uint64_t first = block * kBlockBytes;
  std::vector<std::byte> rows =
      file_.read(first, std::min<std::uint64_t>(kBlockBytes, file_.data_bytes() - first));
  if (xxh3_64(rows) != block_hashes_[block])
    file_.refuse("block " + std::to_string(block), "its bytes do not match their checksum");
  return rows;
}

std::string posting_partition_key(const std::filesystem::path& path) {
  const PostingPartition partition(path);
  for (std::int64_t block = 0; block < partition.blocks(); ++block) partition.read_block(block);
  return partition.header().job_key;
}

}  // namespace semigeo::io
