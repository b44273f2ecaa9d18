#include "bench/recognition/model_library.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <tuple>
#include <utility>

#include "io/hash_library_writer.hpp"

namespace semigeo::recognition {

ModelLibraries::ModelLibraries(ModelSpan models, const jobs::RecognitionParameters& parameters,
                               std::filesystem::path folder, const engine::RunContext& context)
    : folder_(std::move(folder)) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    Entry entry{.index = i,
                .model = jobs::recognition_model(models[i]->built, parameters, context),
                .triplets = {}};
    entry.model.name = models[i]->name;
    // There is no dataset that it could be the digest of.
    char digest[33];
    std::snprintf(digest, sizeof digest, "%032zx", i);
    entry.model.digest = digest;
    entry.triplets = kernels::local_triplets(entry.model.features, {});
    entries_.push_back(std::move(entry));
  }
  std::ranges::sort(entries_, {}, [](const Entry& entry) { return entry.model.name; });
}

std::unique_ptr<io::HashLibrary> ModelLibraries::without(
    const std::vector<std::size_t>& left_out) const {
  std::vector<const Entry*> used;
  for (const Entry& entry : entries_)
    if (std::ranges::count(left_out, entry.index) == 0) used.push_back(&entry);
  std::vector<std::pair<std::uint32_t, kernels::Posting>> found;
  io::LibrarySizes sizes{.models = std::ssize(used)};
  for (std::size_t i = 0; i < used.size(); ++i) {
    sizes.features += std::ssize(used[i]->model.features.features);
    sizes.level_scales += std::ssize(used[i]->model.features.level_scale);
    sizes.samples += std::ssize(used[i]->model.samples.points);
    for (const kernels::Triplet& t : used[i]->triplets)
      found.push_back({t.cell,
                       {.invariants = t.invariants,
                        .model = static_cast<std::uint32_t>(i),
                        .corners = t.corners}});
  }
  std::ranges::sort(found, {}, [](const auto& entry) {
    return std::tie(entry.first, entry.second.model, entry.second.corners);
  });
  sizes.postings = std::ssize(found);
  std::vector<std::uint64_t> cells(kernels::kTripletCells + 1);
  std::vector<kernels::Posting> postings;
  postings.reserve(found.size());
  for (const auto& [cell, posting] : found) {
    postings.push_back(posting);
    ++cells[cell + 1];
  }
  for (std::size_t i = 1; i < cells.size(); ++i) cells[i] += cells[i - 1];

  const std::filesystem::path path = folder_ / "library.h5";
  io::HashLibraryWriter writer(path, {.parameters_json = "{}", .job_key = "bench"}, sizes);
  std::vector<std::byte> rows;
  io::append_packed(std::span<const kernels::Posting>(postings), io::kPostingBytes, rows);
  const auto block = static_cast<std::size_t>(writer.posting_shape().chunk_bytes());
  for (std::size_t at = 0; at < rows.size(); at += block)
    writer.write_block(io::encode_rows(
        writer.posting_shape(), std::span(rows).subspan(at, std::min(block, rows.size() - at))));
  for (const Entry* entry : used) writer.write_model(entry->model, std::ssize(entry->triplets));
  writer.finish(cells);
  return std::make_unique<io::HashLibrary>(path);
}

}  // namespace semigeo::recognition
