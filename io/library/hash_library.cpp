#include "io/library/hash_library.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/files/small_file.hpp"
#include "io/hdf5/array_reader.hpp"
#include "io/library/hash_library_format.hpp"
#include "io/library/packed_model.hpp"
#include "io/library/packed_rows.hpp"

namespace semigeo::io {
namespace {

using kernels::Posting;

const std::string kPostings = "/postings";

std::string counted(std::int64_t index, std::int64_t count) {
  return std::to_string(index) + " of " + std::to_string(count);
}

/// Reads texts that end with NUL, one for each model.
std::vector<std::string> read_texts(const Hdf5File& file, const char* path, std::size_t count) {
  std::vector<std::string> texts;
  std::string text;
  for (const std::int64_t byte : read_integers(file, path, 1)) {
    if (byte != 0) {
      text.push_back(static_cast<char>(byte));
      continue;
    }
    texts.push_back(std::exchange(text, {}));
    if (texts.size() > count) break;
  }
  if (texts.size() != count || !text.empty())
    file.refuse(path, "has not one text for each of " + std::to_string(count) + " models");
  return texts;
}

/// Reads offsets (models + 1). The first is looked at first, because the differences of numbers
/// that ascend from 0 cannot overflow. They must ascend from 0 to the number of rows of `array`,
/// with at most `most` rows for each model.
std::vector<std::int64_t> read_offsets(const Hdf5File& file, const std::string& path,
                                       std::size_t models, std::int64_t rows, std::int64_t most) {
  std::vector<std::int64_t> offsets = read_integers(file, path, 1);
  if (offsets.size() != models + 1)
    file.refuse(
        path, "has not one number for each of " + std::to_string(models) + " models, and the end");
  if (offsets.front() != 0 || offsets.back() != rows)
    file.refuse(path, "its models are not from row 0 to row " + std::to_string(rows));
  for (std::size_t i = 0; i < models; ++i)
    if (offsets[i + 1] < offsets[i] || offsets[i + 1] - offsets[i] > most)
      file.refuse(path, "model " + std::to_string(i) + " ends before it begins, or is too large");
  return offsets;
}

Hdf5File::Array open_rows(const Hdf5File& file, const std::string& path, ElementType type,
                          int columns) {
  Hdf5File::Array array = file.open_array(path);
  if (array.is_virtual() || array.shape().type != type || array.shape().columns != columns)
    file.refuse(path, "has not the type or shape that a library's must have");
  return array;
}

/// Returns the parameters. A text that is not JSON becomes a string, which no program knows
/// as parameters.
nlohmann::json parameters_in(const Hdf5File& file) {
  auto text = file.read_attribute_as<std::string>("/", "parameters");
  auto parameters = parse_json(text, {});  // an object whose brackets are not deep in each other
  if (text.find_first_of("{[") == std::string::npos)
    parameters = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  return parameters.is_discarded() ? nlohmann::json(std::move(text)) : parameters;
}

}  // namespace

struct HashLibrary::State {
  explicit State(const std::filesystem::path& path);

  Hdf5File::Array open(const ModelArray& array) const {
    return open_rows(file, array.path, array.type, array.columns);
  }
  void open_models();
  void read_cells();
  void require_models(std::size_t found, const char* path) const;
  void check_posting(const Posting& posting, std::int64_t index) const;
  void check_features(std::span<const std::byte> records, std::int64_t first) const;
  void check_floats(std::span<const std::byte> floats, const std::string& path) const;
  std::vector<std::byte> read_chunk(const Hdf5File::Array& array, std::int64_t chunk) const;
  std::vector<std::byte> read_rows(const Hdf5File::Array& array,
                                   const std::vector<std::int64_t>& offsets,
                                   std::size_t model) const;
  PackedModel read_model(std::size_t model) const;

  Hdf5File file;
  mutable std::mutex mutex;  // guards the file; rows are checked and unpacked without it
  nlohmann::json parameters;
  std::string digest;
  Hdf5File::Array postings;
  Hdf5File::Array features;
  Hdf5File::Array level_scales;
  Hdf5File::Array sample_points;
  Hdf5File::Array sample_normals;
  std::vector<ModelInfo> models;
  std::vector<std::string> units;
  std::vector<float> centres;
  std::vector<double> origins;
  std::vector<float> spacings;
  std::vector<std::uint32_t> feature_counts;  ///< ModelInfo::features of all models.
  std::vector<std::int64_t> feature_offsets;
  std::vector<std::int64_t> level_offsets;
  std::vector<std::int64_t> sample_offsets;
  std::vector<std::uint64_t> cells;
};

HashLibrary::State::State(const std::filesystem::path& path)
    : file(open_complete(path, kLibraryFormat)),
      parameters(parameters_in(file)),
      digest(file.read_attribute_as<std::string>("/", "digest")),
      postings(open_rows(file, kPostings, ElementType::kPosting, 1)),
      features(open(kFeatureArray)),
      level_scales(open(kLevelScaleArray)),
      sample_points(open(kSamplePointArray)),
      sample_normals(open(kSampleNormalArray)) {
  open_models();
  read_cells();
}

void HashLibrary::State::require_models(std::size_t found, const char* path) const {
  if (found != models.size())
    file.refuse(path, "has not one row for each of " + std::to_string(models.size()) + " models");
}

void HashLibrary::State::open_models() {
  const std::vector<float> diagonals = read_floats(file, "/models/diagonals", 1);
  const std::vector<std::int64_t> triplets = read_integers(file, "/models/triplets", 1);
  models.resize(diagonals.size());
  if (std::cmp_greater(models.size(), kMostModels))
    file.refuse("/models", "has more models than a library can have");
  const std::vector<std::string> names = read_texts(file, kModelNames, models.size());
  const std::vector<std::string> digests = read_texts(file, kModelDigests, models.size());
  units = read_texts(file, kModelUnits, models.size());
  centres = read_floats(file, "/models/centres", 3);
  origins = read_doubles(file, "/models/origins", 3);
  spacings = read_floats(file, "/models/sample_spacings", 1);
  require_models(triplets.size(), "/models/triplets");
  require_models(centres.size() / 3, "/models/centres");
  require_models(origins.size() / 3, "/models/origins");
  require_models(spacings.size(), "/models/sample_spacings");
  if (sample_normals.shape().rows != sample_points.shape().rows)
    file.refuse(kSampleNormalArray.path, "has not one normal for each sample");
  feature_offsets = read_offsets(file, "/models/feature_offsets", models.size(),
                                 features.shape().rows, kernels::kMostFeatures);
  level_offsets = read_offsets(file, "/models/level_offsets", models.size(),
                               level_scales.shape().rows, kMostModelLevels);
  const std::int64_t samples = sample_points.shape().rows;
  sample_offsets = read_offsets(file, "/models/sample_offsets", models.size(), samples, samples);
  for (std::size_t i = 0; i < models.size(); ++i) {
    models[i] = {.name = names[i],
                 .digest = digests[i],
                 .diagonal = diagonals[i],
                 .features = feature_offsets[i + 1] - feature_offsets[i],
                 .samples = sample_offsets[i + 1] - sample_offsets[i],
                 .triplets = triplets[i]};
    feature_counts.push_back(static_cast<std::uint32_t>(models[i].features));
    if (!std::isfinite(diagonals[i]) || !std::isfinite(spacings[i]) ||
        !Eigen::Vector3f(&centres[3 * i]).allFinite() ||
        !Eigen::Vector3d(&origins[3 * i]).allFinite())
      file.refuse("/models", "model " + std::to_string(i) + " has numbers that are not finite");
    if (names[i] <= (i == 0 ? std::string() : names[i - 1]))
      file.refuse(kModelNames, "the names do not ascend");
  }
}

void HashLibrary::State::read_cells() {
  const std::vector<std::int64_t> offsets = read_integers(file, "/cells", 1);
  if (offsets.size() != kernels::kTripletCells + 1)
    file.refuse("/cells", "has " + std::to_string(offsets.size()) + " numbers instead of " +
                              std::to_string(kernels::kTripletCells + 1));
  if (offsets.front() != 0 || offsets.back() != postings.shape().rows)
    file.refuse("/cells", "its cells are not from posting 0 to posting " +
                              std::to_string(postings.shape().rows));
  for (std::size_t i = 1; i < offsets.size(); ++i)
    if (offsets[i] < offsets[i - 1])
      file.refuse("/cells", "cell " + std::to_string(i - 1) + " ends before it begins");
  cells.assign(offsets.begin(), offsets.end());
}

void HashLibrary::State::check_posting(const Posting& posting, std::int64_t index) const {
  const auto count = static_cast<std::int64_t>(models.size());
  if (std::cmp_greater_equal(posting.model, count))
    file.refuse(kPostings, "posting " + std::to_string(index) + " is of model " +
                               counted(posting.model, count));
  for (const std::uint16_t corner : posting.corners)
    if (corner >= feature_counts[posting.model])
      file.refuse(kPostings, "posting " + std::to_string(index) + " refers to feature " +
                                 counted(corner, models[posting.model].features) + " of model " +
                                 std::to_string(posting.model));
}

std::vector<std::byte> HashLibrary::State::read_chunk(const Hdf5File::Array& array,
                                                      std::int64_t chunk) const {
  const ArrayShape& shape = array.shape();
  EncodedChunk encoded;
  {
    const std::lock_guard lock(mutex);
    encoded = array.read_chunk(chunk);
  }
  std::vector<std::byte> rows(static_cast<std::size_t>(shape.chunk_bytes()));
  if (!decode_chunk(shape, encoded.bytes, encoded.filter_mask, rows))
    file.refuse(array.path() + ", chunk " + std::to_string(chunk),
                "its bytes do not match their checksum");
  rows.resize(static_cast<std::size_t>(shape.rows_in_chunk(chunk) * shape.row_bytes()));
  return rows;
}

// Reads the rows of one model.
std::vector<std::byte> HashLibrary::State::read_rows(const Hdf5File::Array& array,
                                                     const std::vector<std::int64_t>& offsets,
                                                     std::size_t model) const {
  const std::int64_t end = offsets[model + 1];
  const ArrayShape& shape = array.shape();
  std::vector<std::byte> rows;
  for (std::int64_t at = offsets[model]; at < end;) {
    const std::int64_t chunk = at / shape.chunk_rows;
    const std::int64_t chunk_first = chunk * shape.chunk_rows;
    const std::int64_t stop = std::min(end, chunk_first + shape.chunk_rows);
    const std::vector<std::byte> all = read_chunk(array, chunk);
    rows.insert(rows.end(), all.begin() + (at - chunk_first) * shape.row_bytes(),
                all.begin() + (stop - chunk_first) * shape.row_bytes());
    at = stop;
  }
  return rows;
}

PackedModel HashLibrary::State::read_model(std::size_t model) const {
  return {.name = models[model].name,
          .digest = models[model].digest,
          .length_unit = units[model],
          .origin = Eigen::Vector3d(&origins[3 * model]),
          .centre = Eigen::Vector3f(&centres[3 * model]),
          .diagonal = models[model].diagonal,
          .sample_spacing = spacings[model],
          .level_scales = unpacked<float>(read_rows(level_scales, level_offsets, model)),
          .features = read_rows(features, feature_offsets, model),
          .sample_points = read_rows(sample_points, sample_offsets, model),
          .sample_normals = read_rows(sample_normals, sample_offsets, model)};
}

// Checks some rows of the features of all models. `first` is the number of the first row.
void HashLibrary::State::check_features(std::span<const std::byte> records,
                                        std::int64_t first) const {
  auto model = static_cast<std::size_t>(std::ranges::upper_bound(feature_offsets, first) -
                                        feature_offsets.begin() - 1);
  while (!records.empty()) {
    const std::size_t here =
        std::min(records.size(), static_cast<std::size_t>(feature_offsets[model + 1] - first) *
                                     kOrientedFeatureBytes);
    const auto levels = static_cast<std::size_t>(level_offsets[model + 1] - level_offsets[model]);
    if (const auto problem = problem_of_features(records.first(here), levels))
      file.refuse(kFeatureArray.path, "model " + std::to_string(model) + " " + *problem);
    records = records.subspan(here);
    first = feature_offsets[++model];
  }
}

void HashLibrary::State::check_floats(std::span<const std::byte> floats,
                                      const std::string& path) const {
  if (const auto problem = problem_of_floats(floats)) file.refuse(path, *problem);
}

HashLibrary::HashLibrary(const std::filesystem::path& path)
    : state_(std::make_unique<State>(path)) {}
HashLibrary::~HashLibrary() = default;
HashLibrary::HashLibrary(HashLibrary&&) noexcept = default;
HashLibrary& HashLibrary::operator=(HashLibrary&&) noexcept = default;

const std::filesystem::path& HashLibrary::path() const {
  return state_->file.path();
}
const nlohmann::json& HashLibrary::parameters() const {
  return state_->parameters;
}
const std::string& HashLibrary::digest() const {
  return state_->digest;
}
const std::vector<ModelInfo>& HashLibrary::models() const {
  return state_->models;
}
std::span<const std::uint64_t> HashLibrary::cells() const {
  return state_->cells;
}
std::int64_t HashLibrary::posting_count() const {
  return state_->postings.shape().rows;
}
std::int64_t HashLibrary::block_size() const {
  return state_->postings.shape().chunk_rows;
}

std::vector<Posting> HashLibrary::read_block(std::int64_t block) const {
  const ArrayShape& shape = state_->postings.shape();
  if (block < 0 || block >= shape.chunk_count())
    state_->file.refuse(kPostings, "has no block " + counted(block, shape.chunk_count()));
  std::vector<Posting> postings =
      unpacked<Posting>(state_->read_chunk(state_->postings, block), kPostingBytes);
  std::int64_t index = block * shape.chunk_rows;
  for (const Posting& posting : postings) state_->check_posting(posting, index++);
  return postings;
}

kernels::RecognitionModel HashLibrary::read_model(std::int64_t model) const {
  const auto count = static_cast<std::int64_t>(models().size());
  if (model < 0 || model >= count)
    state_->file.refuse("/models", "has no model " + counted(model, count));
  const PackedModel packed = state_->read_model(static_cast<std::size_t>(model));
  if (const auto problem = problem_of(packed))
    state_->file.refuse("/models", "model " + std::to_string(model) + " " + *problem);
  return unpack_model(packed);
}

namespace {

/// Checks the order and the counts of all postings. It receives their blocks from any threads and
/// in any order.
class PostingCheck {
 public:
  PostingCheck(const Hdf5File& file, std::span<const std::uint64_t> cells, std::size_t models,
               std::int64_t block_size)
      : file_(file),
        cells_(cells),
        block_size_(static_cast<std::uint64_t>(block_size)),
        ends_(static_cast<std::size_t>((cells.back() + block_size_ - 1) / block_size_)),
        counts_(models) {}

  /// Takes the postings from `index` on.
  void add(std::uint64_t index, std::span<const Posting> postings) {
    ends_[index / block_size_] = {postings.front(), postings.back()};
    std::uint64_t cell_end = 0;
    for (std::size_t i = 0; i < postings.size(); ++i) {
      const std::uint64_t here = index + i;
      if (here < cell_end && !in_order(postings[i - 1], postings[i])) refuse(here);
      if (here >= cell_end) cell_end = *std::ranges::upper_bound(cells_, here);
      counts_[postings[i].model].fetch_add(1, std::memory_order_relaxed);
    }
  }

  /// Checks the order from block to block, after all blocks were taken.
  void finish() const {
    for (std::size_t block = 1; block < ends_.size(); ++block)
      if (!std::ranges::binary_search(cells_, block * block_size_) &&
          !in_order(ends_[block - 1].last, ends_[block].first))
        refuse(block * block_size_);
  }
  std::int64_t count(std::size_t model) const { return counts_[model]; }

 private:
  struct Ends {
    Posting first;
    Posting last;
  };

  // A cell has each triangle at most once.
  static bool in_order(const Posting& a, const Posting& b) {
    return a.model < b.model || (a.model == b.model && a.corners < b.corners);
  }

  [[noreturn]] void refuse(std::uint64_t index) const {
    file_.refuse(kPostings, "posting " + std::to_string(index) +
                                " is not behind the one before it in its cell");
  }

  const Hdf5File& file_;
  std::span<const std::uint64_t> cells_;
  std::uint64_t block_size_;
  std::vector<Ends> ends_;  ///< First and last posting of each block.
  std::vector<std::atomic<std::int64_t>> counts_;
};

}  // namespace

void HashLibrary::verify(const ForEach& for_each) const {
  const State& state = *state_;
  const std::lock_guard lock(state.mutex);
  PostingCheck check(state.file, state.cells, state.models.size(), block_size());
  const auto look = [&](const std::string& path, std::int64_t first,
                        std::span<const std::byte> rows) {
    if (path == kPostings) {
      const std::vector<Posting> postings = unpacked<Posting>(rows, kPostingBytes);
      for (std::int64_t index = first; const Posting& posting : postings)
        state.check_posting(posting, index++);
      check.add(static_cast<std::uint64_t>(first), postings);
    } else if (path == kFeatureArray.path) {
      state.check_features(rows, first);
    } else if (path == kSamplePointArray.path || path == kLevelScaleArray.path) {
      state.check_floats(rows, path);
    }
  };
  const std::string found = content_digest(state.file, look, for_each);
  check.finish();
  for (std::size_t i = 0; i < state.models.size(); ++i)
    if (check.count(i) != state.models[i].triplets)
      state.file.refuse("/models/triplets", "model " + std::to_string(i) + " has " +
                                                std::to_string(check.count(i)) + " postings, not " +
                                                std::to_string(state.models[i].triplets));
  if (found != state.digest)
    state.file.refuse("attribute digest",
                      "is " + state.digest + ", but the content has the digest " + found);
}

std::string library_key(const std::filesystem::path& path) {
  return open_complete(path, kLibraryFormat).read_attribute_as<std::string>("/", "job_key");
}

}  // namespace semigeo::io
