#include "tests/io/library/sample_library.hpp"

#include <algorithm>
#include <tuple>

#include "io/library/hash_library_writer.hpp"
#include "io/library/packed_rows.hpp"

namespace semigeo::tests {

SampleLibrary::SampleLibrary(int count, const ModelSize& size) {
  for (int i = 0; i < count; ++i) {
    models.push_back(generated_model(i, size));
    triplets.push_back(generated_triplets(i, models.back(), size));
  }
  post();
}

void SampleLibrary::post() {
  std::vector<std::pair<std::uint32_t, kernels::Posting>> entries;
  for (std::uint32_t model = 0; model < triplets.size(); ++model)
    for (const kernels::Triplet& t : triplets[model])
      entries.push_back(
          {t.cell, {.invariants = t.invariants, .model = model, .corners = t.corners}});
  std::ranges::sort(entries, {}, [](const auto& entry) {
    return std::tie(entry.first, entry.second.model, entry.second.corners);
  });
  postings.clear();
  cells.assign(kernels::kTripletCells + 1, 0);
  for (const auto& [cell, posting] : entries) {
    postings.push_back(posting);
    ++cells[cell + 1];
  }
  for (std::size_t i = 1; i < cells.size(); ++i) cells[i] += cells[i - 1];
}

std::string write_library(const std::filesystem::path& path, const SampleLibrary& sample) {
  io::LibrarySizes sizes{.postings = static_cast<std::int64_t>(sample.postings.size()),
                         .models = static_cast<std::int64_t>(sample.models.size())};
  for (const kernels::RecognitionModel& model : sample.models) {
    sizes.features += static_cast<std::int64_t>(model.features.features.size());
    sizes.level_scales += static_cast<std::int64_t>(model.features.level_scale.size());
    sizes.samples += static_cast<std::int64_t>(model.samples.points.size());
  }
  io::HashLibraryWriter writer(path, {.parameters = {{"levels", 3}}, .job_key = "key"}, sizes);
  const std::vector<std::byte> rows = io::packed(std::span(sample.postings), io::kPostingBytes);
  const io::ArrayShape& shape = writer.posting_shape();
  const auto block = static_cast<std::size_t>(shape.chunk_bytes());
  for (std::size_t at = 0; at < rows.size(); at += block)
    writer.write_block(
        io::encode_rows(shape, std::span(rows).subspan(at, std::min(block, rows.size() - at))));
  for (std::size_t i = 0; i < sample.models.size(); ++i)
    writer.write_model(io::pack_model(sample.models[i]),
                       static_cast<std::int64_t>(sample.triplets[i].size()));
  return writer.finish(sample.cells);
}

}  // namespace semigeo::tests
