#include "io/library/hash_library_writer.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "io/library/hash_library.hpp"

namespace semigeo::io {
namespace {

DigestedFile begin_file(const AtomicFile& target, const LibraryHeader& header) {
  DigestedFile file(Hdf5File::create(target.temporary_path(), target.final_path()));
  write_format(file, kLibraryFormat);
  file.write_attribute("/", "parameters", header.parameters.dump());
  file.write_attribute("/", "job_key", header.job_key);
  file.create_group("/models");
  return file;
}

ArrayShape chunked(ElementType type, int columns, std::int64_t rows, std::int64_t chunk_rows) {
  return {.type = type,
          .rows = rows,
          .columns = columns,
          .chunk_rows = std::max<std::int64_t>(1, std::min(rows, chunk_rows)),
          .compression = Compression::kNone};
}

void add_text(std::string& texts, const std::string& text) {
  texts.append(text).push_back('\0');
}

}  // namespace

HashLibraryWriter::HashLibraryWriter(const std::filesystem::path& final_path,
                                     const LibraryHeader& header, const LibrarySizes& sizes)
    : target_(final_path),
      file_(begin_file(target_, header)),
      sizes_(sizes),
      postings_(file_.begin_array(
          "/postings", chunked(ElementType::kPosting, 1, sizes.postings, kBlockPostings))),
      features_(begin_rows(kFeatureArray, sizes.features)),
      level_scales_(begin_rows(kLevelScaleArray, sizes.level_scales)),
      sample_points_(begin_rows(kSamplePointArray, sizes.samples)),
      sample_normals_(begin_rows(kSampleNormalArray, sizes.samples)) {
  if (sizes.models < 0 || sizes.models > kMostModels)
    throw std::invalid_argument("more models than a library holds");
}

HashLibraryWriter::Rows HashLibraryWriter::begin_rows(const ModelArray& array, std::int64_t rows) {
  return {.array = file_.begin_array(array.path,
                                     chunked(array.type, array.columns, rows, array.chunk_rows)),
          .pending = {}};
}

void HashLibraryWriter::Rows::add(std::span<const std::byte> rows) {
  const auto row_bytes = static_cast<std::size_t>(array.shape().row_bytes());
  const auto chunk_bytes = static_cast<std::size_t>(array.shape().chunk_bytes());
  offsets.push_back(offsets.back() + static_cast<std::int64_t>(rows.size() / row_bytes));
  pending.insert(pending.end(), rows.begin(), rows.end());
  std::size_t done = 0;
  for (; pending.size() - done >= chunk_bytes; done += chunk_bytes)
    array.write_chunk(encode_rows(array.shape(), std::span(pending).subspan(done, chunk_bytes)));
  pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(done));
}

void HashLibraryWriter::Rows::close() {
  if (offsets.back() != array.shape().rows)
    throw std::invalid_argument("the models have not as many rows as was said");
  if (!pending.empty()) array.write_chunk(encode_rows(array.shape(), pending));
  array.close();
}

void HashLibraryWriter::write_block(const EncodedChunk& block) {
  postings_.write_chunk(block);
  ++blocks_;
}

void HashLibraryWriter::write_model(const PackedModel& model, std::int64_t triplets) {
  if (blocks_ != postings_.shape().chunk_count())
    throw std::invalid_argument("models come after the postings");
  if (model.name <= last_name_) throw std::invalid_argument("names of models must ascend");
  if (const auto problem = problem_of(model))
    throw std::invalid_argument("model " + model.name + " " + *problem);
  last_name_ = model.name;
  add_text(names_, model.name);
  add_text(digests_, model.digest);
  add_text(units_, model.length_unit);
  centres_.insert(centres_.end(), model.centre.begin(), model.centre.end());
  origins_.insert(origins_.end(), model.origin.begin(), model.origin.end());
  diagonals_.push_back(model.diagonal);
  spacings_.push_back(model.sample_spacing);
  triplets_.push_back(triplets);
  features_.add(model.features);
  level_scales_.add(std::as_bytes(std::span(model.level_scales)));
  sample_points_.add(model.sample_points);
  sample_normals_.add(model.sample_normals);
}

void HashLibraryWriter::write_small(const std::string& path, const ArrayView& view) {
  file_.write_array(path, encode_array(view, Compression::kDeflate));
}

std::string HashLibraryWriter::finish(std::span<const std::uint64_t> cells,
                                      const ForEach& for_each) {
  if (std::cmp_not_equal(triplets_.size(), sizes_.models))
    throw std::invalid_argument("not as many models as was said");
  if (cells.size() != kernels::kTripletCells + 1)
    throw std::invalid_argument("the index has not every cell");
  postings_.close();
  for (Rows* rows : {&features_, &level_scales_, &sample_points_, &sample_normals_}) rows->close();
  const auto text = [](const std::string& texts) {
    return array_of(std::span(reinterpret_cast<const std::uint8_t*>(texts.data()), texts.size()));
  };
  const auto three = [](const auto& values, ArrayView view) {
    view.columns = 3;
    view.row_stride = 3 * sizeof values[0];
    view.rows /= 3;
    return view;
  };
  write_small(kModelNames, text(names_));
  write_small(kModelDigests, text(digests_));
  write_small(kModelUnits, text(units_));
  write_small("/models/centres", three(centres_, array_of(std::span<const float>(centres_))));
  write_small("/models/origins", three(origins_, array_of(std::span<const double>(origins_))));
  write_small("/models/diagonals", array_of(std::span<const float>(diagonals_)));
  write_small("/models/sample_spacings", array_of(std::span<const float>(spacings_)));
  write_small("/models/triplets", array_of(std::span<const std::int64_t>(triplets_)));
  write_small("/models/feature_offsets",
              array_of(std::span<const std::int64_t>(features_.offsets)));
  write_small("/models/level_offsets",
              array_of(std::span<const std::int64_t>(level_scales_.offsets)));
  write_small("/models/sample_offsets",
              array_of(std::span<const std::int64_t>(sample_points_.offsets)));
  write_small("/cells", array_of(std::span(reinterpret_cast<const std::int64_t*>(cells.data()),
                                           cells.size())));
  std::string digest = complete_file(file_, target_, [&](const std::filesystem::path& path) {
    const HashLibrary written(path);
    written.verify(for_each);
    return written.digest();
  });
  target_.commit();
  return digest;
}

}  // namespace semigeo::io
