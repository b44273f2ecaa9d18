#include "io/library/triplet_run.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "io/files/chunk_codec.hpp"

namespace semigeo::io {
namespace {

using kernels::kCodeTriples;
using kernels::kShapes;
using kernels::Triplet;

constexpr BinaryFormat kRunFormat = {
    .magic = "semigeoT", .version = 1, .noun = "a run of triplets"};

/// Holds a triplet as it is stored, without its shape.
struct Row {
  std::uint16_t codes;  ///< cell % kCodeTriples
  kernels::Invariants invariants;
  std::array<std::uint16_t, 3> corners;
};
static_assert(sizeof(Row) == 24);

constexpr const char* kNoFeature = "refers to a feature that does not exist";
constexpr const char* kNotBehind = "is not behind the one before it";

/// Returns what is wrong with a triplet that comes after `last`, or nothing.
const char* problem_of(const Triplet& triplet, const Triplet* last, std::int64_t features) {
  if (triplet.cell >= kernels::kTripletCells) return "is in a cell that does not exist";
  for (const std::uint16_t corner : triplet.corners)
    if (corner >= features) return kNoFeature;
  if (last != nullptr &&
      std::tie(triplet.cell, triplet.corners) <= std::tie(last->cell, last->corners))
    return kNotBehind;
  return nullptr;
}

std::vector<std::byte> tables_of(const PackedModel& model) {
  std::vector<std::byte> tables = model.features;
  tables.insert(tables.end(), model.sample_points.begin(), model.sample_points.end());
  tables.insert(tables.end(), model.sample_normals.begin(), model.sample_normals.end());
  return tables;
}

void check(const PackedModel& model, std::span<const Triplet> triplets) {
  if (const auto problem = problem_of(model))
    throw std::invalid_argument("model " + model.name + " " + *problem);
  const Triplet* last = nullptr;
  for (const Triplet& triplet : triplets) {
    if (const char* problem = problem_of(triplet, last, model.feature_count()))
      throw std::invalid_argument("a triplet of " + model.name + " " + problem);
    last = &triplet;
  }
  if (triplets.size() > UINT32_MAX) throw std::invalid_argument("too many triplets");
}

void add_header(HeadWriter& head, const std::string& job_key, const PackedModel& model) {
  head.text(job_key);
  head.text(model.name);
  head.text(model.digest);
  head.text(model.length_unit);
  head.numbers(std::span<const double>(model.origin.data(), 3));
  head.numbers(std::span<const float>(model.centre.data(), 3));
  head.number(model.diagonal);
  head.number(model.sample_spacing);
  head.number<std::uint64_t>(model.level_scales.size());
  head.numbers(std::span<const float>(model.level_scales));
  head.number(model.feature_count());
  head.number(model.sample_count());
}

}  // namespace

void write_triplet_run(const std::filesystem::path& path, const std::string& job_key,
                       const kernels::RecognitionModel& model, std::span<const Triplet> triplets) {
  const PackedModel packed = pack_model(model);
  check(packed, triplets);
  HeadWriter head;
  add_header(head, job_key, packed);
  std::vector<Row> rows;
  rows.reserve(triplets.size());
  std::array<std::uint32_t, kShapes + 1> offsets = {};
  for (const Triplet& t : triplets) {
    rows.push_back({static_cast<std::uint16_t>(t.cell % kCodeTriples), t.invariants, t.corners});
    ++offsets[t.cell / kCodeTriples + 1];
  }
  std::array<std::uint64_t, kShapes> hashes = {};
  for (int shape = 0; shape < kShapes; ++shape) {
    offsets[shape + 1] += offsets[shape];
    hashes[shape] = xxh3_64(std::as_bytes(
        std::span(rows).subspan(offsets[shape], offsets[shape + 1] - offsets[shape])));
  }
  const std::vector<std::byte> tables = tables_of(packed);
  head.numbers(std::span<const std::uint32_t>(offsets));
  head.numbers(std::span<const std::uint64_t>(hashes));
  head.number(xxh3_64(tables));
  BinaryWriter file(path, kRunFormat);
  file.data(std::as_bytes(std::span(rows)));
  file.data(tables);
  file.finish_unsynced(head);
}

TripletRun::TripletRun(const std::filesystem::path& path) : file_(path, kRunFormat) {
  read_head();
  check_sizes();
}

void TripletRun::read_head() {
  job_key_ = file_.text();
  model_.name = file_.text();
  model_.digest = file_.text();
  model_.length_unit = file_.text();
  file_.numbers(std::span<double>(model_.origin.data(), 3));
  file_.numbers(std::span<float>(model_.centre.data(), 3));
  model_.diagonal = file_.number<float>();
  model_.sample_spacing = file_.number<float>();
  model_.level_scales = file_.numbers<float>(file_.number<std::uint64_t>());
  features_ = file_.number<std::int64_t>();
  samples_ = file_.number<std::int64_t>();
  file_.numbers(std::span<std::uint32_t>(offsets_));
  file_.numbers(std::span<std::uint64_t>(shape_hashes_));
  model_hash_ = file_.number<std::uint64_t>();
  file_.end_of_head();
}

void TripletRun::check_sizes() const {
  if (const auto problem = io::problem_of(model_)) file_.refuse("head", "its model " + *problem);
  for (int shape = 0; shape < kShapes; ++shape)
    if (offsets_[shape + 1] < offsets_[shape])
      file_.refuse("head", "shape " + std::to_string(shape) + " ends before it begins");
  if (offsets_[0] != 0) file_.refuse("head", "its first shape does not begin at triplet 0");
  constexpr auto kMostSamples = std::int64_t{1} << 40;
  if (features_ < 0 || features_ > static_cast<std::int64_t>(kernels::kMostFeatures) ||
      samples_ < 0 || samples_ > kMostSamples)
    file_.refuse("head", "has too many features or samples");
  const std::uint64_t bytes =
      sizeof(Row) * offsets_[kShapes] +
      kOrientedFeatureBytes * static_cast<std::uint64_t>(features_) +
      (kSamplePointBytes + kSampleNormalBytes) * static_cast<std::uint64_t>(samples_);
  if (bytes != file_.data_bytes())
    file_.refuse("", "has " + std::to_string(file_.data_bytes()) + " bytes of data instead of " +
                         std::to_string(bytes));
}

std::vector<Triplet> TripletRun::read_triplets(const ShapeRange& shapes) const {
  const std::uint64_t first = offsets_[shapes.first];
  const std::vector<std::byte> bytes =
      file_.read(sizeof(Row) * first, sizeof(Row) * (offsets_[shapes.end] - first));
  std::vector<Triplet> triplets(bytes.size() / sizeof(Row));
  std::size_t i = 0;
  for (int shape = shapes.first; shape < shapes.end; ++shape) {
    const std::size_t end = offsets_[shape + 1] - first;
    if (i == end) continue;
    const std::string place = "shape " + std::to_string(shape);
    if (xxh3_64(std::span(bytes).subspan(i * sizeof(Row), (end - i) * sizeof(Row))) !=
        shape_hashes_[shape])
      file_.refuse(place, "its bytes do not match their checksum");
    std::uint64_t last = 0;
    for (const std::size_t begin = i; i < end; ++i) {
      Row row;
      std::memcpy(static_cast<void*>(&row), bytes.data() + i * sizeof row, sizeof row);
      const auto refuse = [&](const char* problem) {
        file_.refuse(place, "triplet " + std::to_string(first + i) + " " + problem);
      };
      const auto [a, b, c] = row.corners;
      const std::uint64_t key =
          std::uint64_t{row.codes} << 48 | std::uint64_t{a} << 32 | std::uint64_t{b} << 16 | c;
      if (row.codes >= kCodeTriples) refuse("is in a cell of another shape");
      if (std::max({a, b, c}) >= features_) refuse(kNoFeature);
      if (i > begin && key <= last) refuse(kNotBehind);
      last = key;
      triplets[i] = {.cell = static_cast<std::uint32_t>(shape * kCodeTriples + row.codes),
                     .invariants = row.invariants,
                     .corners = row.corners};
    }
  }
  return triplets;
}

PackedModel TripletRun::read_packed_model() const {
  const std::uint64_t first = sizeof(Row) * static_cast<std::uint64_t>(offsets_[kShapes]);
  const std::vector<std::byte> tables = file_.read(first, file_.data_bytes() - first);
  if (xxh3_64(tables) != model_hash_)
    file_.refuse("tables of the model", "their bytes do not match their checksum");
  PackedModel model = model_;
  auto at = tables.begin();
  const auto take = [&at](std::vector<std::byte>& table, std::size_t bytes) {
    table.assign(at, at + static_cast<std::ptrdiff_t>(bytes));
    at += static_cast<std::ptrdiff_t>(bytes);
  };
  take(model.features, kOrientedFeatureBytes * features_);
  take(model.sample_points, kSamplePointBytes * samples_);
  take(model.sample_normals, kSampleNormalBytes * samples_);
  if (const auto problem = io::problem_of(model))
    file_.refuse("tables of the model", "it " + *problem);
  return model;
}

std::string triplet_run_key(const std::filesystem::path& path) {
  const TripletRun run(path);
  run.read_triplets();
  run.read_packed_model();
  return run.job_key();
}

}  // namespace semigeo::io
