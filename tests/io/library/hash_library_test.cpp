#include "io/library/hash_library.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <set>
#include <stdexcept>
#include <thread>

#include "io/files/error.hpp"
#include "io/library/hash_library_writer.hpp"
#include "io/library/packed_normal.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

using tests::SampleLibrary;
using tests::TemporaryFolder;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string read_all(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_all(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<kernels::Posting> all_postings(const HashLibrary& library) {
  std::vector<kernels::Posting> postings;
  for (std::int64_t at = 0; at < library.posting_count(); at += library.block_size()) {
    const auto block = library.read_block(at / library.block_size());
    postings.insert(postings.end(), block.begin(), block.end());
  }
  return postings;
}

void expect_equal_features(const kernels::OrientedFeatures& a, const kernels::OrientedFeatures& b) {
  EXPECT_EQ(a.level_scale, b.level_scale);
  ASSERT_EQ(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    EXPECT_EQ(a.features[i].position, b.features[i].position);
    EXPECT_EQ(a.features[i].normal, b.features[i].normal);
    EXPECT_EQ(a.features[i].scale_free_gaussian, b.features[i].scale_free_gaussian);
    EXPECT_EQ(a.features[i].scale_free_mean, b.features[i].scale_free_mean);
    EXPECT_EQ(a.features[i].value, b.features[i].value);
    EXPECT_EQ(a.features[i].code, b.features[i].code);
    EXPECT_EQ(a.features[i].level, b.features[i].level);
  }
}

void expect_same_model(const kernels::RecognitionModel& stored,
                       const kernels::RecognitionModel& given) {
  EXPECT_EQ(stored.name, given.name);
  EXPECT_EQ(stored.digest, given.digest);
  EXPECT_EQ(stored.length_unit, given.length_unit);
  EXPECT_EQ(stored.origin, given.origin);
  EXPECT_EQ(stored.centre, given.centre);
  EXPECT_EQ(stored.diagonal, given.diagonal);
  EXPECT_EQ(stored.samples.spacing, given.samples.spacing);
  EXPECT_EQ(stored.samples.points, given.samples.points);
  ASSERT_EQ(stored.samples.normals.size(), given.samples.normals.size());
  for (std::size_t i = 0; i < given.samples.normals.size(); ++i)
    EXPECT_EQ(stored.samples.normals[i], unpack_normal(pack_normal(given.samples.normals[i])));
  expect_equal_features(stored.features, given.features);
}

class HashLibraryTest : public testing::Test {
 protected:
  std::filesystem::path write(const SampleLibrary& sample, const char* name = "library.h5") {
    digest_ = write_library(folder_ / name, sample);
    return folder_ / name;
  }

  TemporaryFolder folder_;
  std::string digest_;
};

TEST_F(HashLibraryTest, HoldsWhatWasWritten) {
  const SampleLibrary sample(90);  // more than a block, and a part of one
  const HashLibrary library(write(sample));
  EXPECT_EQ(library.parameters(), (nlohmann::json{{"levels", 3}}));
  EXPECT_EQ(library.digest(), digest_);
  EXPECT_EQ(library_key(library.path()), "key");
  ASSERT_EQ(library.models().size(), sample.models.size());
  EXPECT_EQ(library.block_size(), kBlockPostings);
  EXPECT_GT(library.posting_count(), kBlockPostings);
  EXPECT_EQ(all_postings(library), sample.postings);
  EXPECT_TRUE(std::ranges::equal(library.cells(), sample.cells));
  for (std::size_t i = 0; i < sample.models.size(); ++i) {
    const ModelInfo& info = library.models()[i];
    EXPECT_EQ(info.name, sample.models[i].name);
    EXPECT_EQ(info.digest, sample.models[i].digest);
    EXPECT_EQ(info.diagonal, sample.models[i].diagonal);
    EXPECT_EQ(info.features, sample.models[i].features.features.size());
    EXPECT_EQ(info.samples, sample.models[i].samples.points.size());
    EXPECT_EQ(info.triplets, sample.triplets[i].size());
    expect_same_model(library.read_model(static_cast<std::int64_t>(i)), sample.models[i]);
  }
  library.verify();
}

// Order is looked at block by block, on any threads, and between blocks afterwards.
TEST_F(HashLibraryTest, OrderIsCheckedFromBlockToBlock) {
  SampleLibrary sample(90);
  const std::uint64_t first = kBlockPostings - 5;
  const std::uint64_t last = kBlockPostings + 5;
  for (std::uint64_t& cell : sample.cells)  // one cell has them all
    if (cell > first && cell < last) cell = last;
  std::ranges::sort(
      std::span(sample.postings).subspan(first, last - first), {},
      [](const kernels::Posting& posting) { return std::pair(posting.model, posting.corners); });
  const ForEach all_at_once = [](std::int64_t count, const auto& body) {
    std::vector<std::jthread> threads;
    for (std::int64_t i = 0; i < count; ++i) threads.emplace_back(body, i);
  };
  HashLibrary(write(sample)).verify(all_at_once);
  std::swap(sample.postings[kBlockPostings - 1], sample.postings[kBlockPostings]);
  EXPECT_NE(message_of([&] { write(sample); }).find("posting 65536 is not behind"),
            std::string::npos);
}

TEST_F(HashLibraryTest, MayBeEmpty) {
  const HashLibrary none(write(SampleLibrary(0)));
  EXPECT_TRUE(none.models().empty());
  EXPECT_EQ(none.posting_count(), 0);
  none.verify();
  const HashLibrary bare(write(SampleLibrary(2, {.features = 0, .samples = 0})));
  EXPECT_EQ(bare.read_model(1).features.features.size(), 0U);
  EXPECT_EQ(bare.read_model(1).name, tests::generated_name(1));
  bare.verify();
}

TEST_F(HashLibraryTest, EqualContentGivesEqualBytes) {
  const SampleLibrary sample(5);
  EXPECT_EQ(read_all(write(sample, "a")), read_all(write(sample, "b")));
}

TEST_F(HashLibraryTest, RefusesWhatDoesNotExist) {
  const HashLibrary library(write(SampleLibrary(3)));
  EXPECT_THROW(library.read_block(1), Error);
  EXPECT_THROW(library.read_block(-1), Error);
  EXPECT_THROW(library.read_model(3), Error);
  EXPECT_THROW(library.read_model(-1), Error);
}

TEST_F(HashLibraryTest, ManyThreadsReadTheSame) {
  const SampleLibrary sample(70);
  const HashLibrary library(write(sample));
  std::vector<std::thread> threads;
  std::atomic<int> equal = 0;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = t; i < 70; i += 4)
        if (library.read_model(i).samples.points == sample.models[i].samples.points) ++equal;
      if (all_postings(library) == sample.postings) ++equal;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(equal, 74);
}

// Whatever byte is wrong: an Error, or what it said before.
TEST_F(HashLibraryTest, DamageIsNoticed) {
  const SampleLibrary sample(3, {.features = 40, .samples = 50, .triplets = 200});
  const auto path = write(sample);
  const std::string good = read_all(path);
  std::int64_t noticed = 0;
  std::int64_t places = 0;
  for (std::size_t at = 0; at < good.size(); at += 211, ++places) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1 << places % 8);
    write_all(path, bad);
    try {
      const HashLibrary library(path);
      library.verify();
      EXPECT_EQ(all_postings(library), sample.postings) << "byte " << at;
      EXPECT_TRUE(std::ranges::equal(library.cells(), sample.cells)) << "byte " << at;
      for (std::size_t i = 0; i < sample.models.size(); ++i)
        expect_same_model(library.read_model(static_cast<std::int64_t>(i)), sample.models[i]);
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), path);
      ++noticed;
    }
  }
  EXPECT_GT(noticed, places / 3);  // a third is room in B-trees that nothing uses
  for (std::size_t size = 0; size < good.size(); size += 7001) {
    write_all(path, good.substr(0, size));
    EXPECT_THROW(HashLibrary(path).verify(), Error) << size << " bytes";
  }
}

TEST_F(HashLibraryTest, RefusesOtherFiles) {
  const auto path = folder_ / "other";
  EXPECT_THROW(HashLibrary{path}, Error);
  write_all(path, "text");
  EXPECT_THROW(HashLibrary{path}, Error);
  DigestedFile(Hdf5File::create(path)).file().close();
  EXPECT_NE(message_of([&] { HashLibrary{path}; }).find("not a semigeo library"),
            std::string::npos);
  Hdf5File future = Hdf5File::create(path);
  future.write_attribute("/", "format", kLibraryFormat.name);
  future.write_attribute("/", "format_version", kLibraryFormat.version + 1);
  future.close();
  EXPECT_NE(message_of([&] { HashLibrary{path}; }).find("has library format 2"), std::string::npos);
  Hdf5File torn = Hdf5File::create(path);
  torn.write_attribute("/", "format", kLibraryFormat.name);
  torn.write_attribute("/", "format_version", kLibraryFormat.version);
  torn.close();
  EXPECT_NE(message_of([&] { HashLibrary{path}; }).find("not written to its end"),
            std::string::npos);
}

// Files that are whole, with a digest that is right, but whose content contradicts itself.
struct Contradiction {
  const char* name;
  std::function<void(SampleLibrary&)> make;
  const char* message;
};

class Contradicting : public HashLibraryTest, public testing::WithParamInterface<Contradiction> {};

TEST_P(Contradicting, IsRefused) {
  SampleLibrary sample(3);
  GetParam().make(sample);
  const std::string message = message_of([&] { write(sample); });
  EXPECT_NE(message.find("reads back wrong"), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "library.h5"));
}

INSTANTIATE_TEST_SUITE_P(
    Each, Contradicting,
    testing::Values(
        Contradiction{"Model", [](SampleLibrary& s) { s.postings[7].model = 3; },
                      "posting 7 is of model 3 of 3"},
        Contradiction{"NegativeModel", [](SampleLibrary& s) { s.postings[7].model = 0xffffffff; },
                      "posting 7 is of model 4294967295 of 3"},
        Contradiction{"Corner", [](SampleLibrary& s) { s.postings[8].corners[2] = 300; },
                      "posting 8 refers to feature 300 of 300"},
        Contradiction{"Order",
                      [](SampleLibrary& s) {
                        std::size_t cell = 0;  // one with at least two
                        while (s.cells[cell + 1] < s.cells[cell] + 2) ++cell;
                        std::swap(s.postings[s.cells[cell]], s.postings[s.cells[cell] + 1]);
                      },
                      "is not behind the one before it"},
        Contradiction{"CellsDescend", [](SampleLibrary& s) { s.cells[100000] = 0; },
                      "ends before it begins"},
        Contradiction{"CellsBegin", [](SampleLibrary& s) { s.cells[0] = 1; }, "not from posting 0"},
        Contradiction{"CellsEnd", [](SampleLibrary& s) { s.cells.back() += 1; },
                      "not from posting 0"},
        Contradiction{"Counts", [](SampleLibrary& s) { s.triplets[1].pop_back(); }, "model 1 has"}),
    [](const auto& test) { return std::string(test.param.name); });

/// Copies a library, its arrays changed by `change`, with a digest that is right again.
void rewrite(const std::filesystem::path& from, const std::filesystem::path& to,
             const std::function<void(const std::string&, std::vector<std::byte>&)>& change) {
  const Hdf5File file = Hdf5File::open(from);
  AtomicFile target(to);
  DigestedFile copy(Hdf5File::create(target.temporary_path(), to));
  for (const Hdf5Attribute& attribute : file.attributes("/"))
    if (attribute.name != "digest" && attribute.name != "complete")
      copy.write_attribute("/", attribute.name, attribute.value);
  copy.create_group("/models");
  for (const std::string group : {"/", "/models/"})
    for (const Hdf5Link& link : file.links(group)) {
      if (link.kind != Hdf5Link::Kind::kArray) continue;
      const std::string path = group + link.name;
      std::vector<std::byte> bytes = file.read_through_library(path);
      change(path, bytes);
      ArrayShape shape = file.shape_of(path);
      shape.rows = static_cast<std::int64_t>(bytes.size()) / shape.row_bytes();
      shape.chunk_rows = shape.rows;
      copy.write_array(path, {shape, {encode_rows(shape, bytes)}});
    }
  complete_file(copy, target, [&](const std::filesystem::path& path) {
    return Hdf5File::open(path).read_attribute_as<std::string>("/", "digest");
  });
  target.commit();
}

/// One value of an array of a library of three models that makes it nonsense.
struct Nonsense {
  const char* name;
  const char* array;
  std::size_t byte;
  std::vector<std::uint8_t> bytes;
  const char* message;  ///< at opening, or of both verify and whoever reads it
};

class Nonsensical : public HashLibraryTest, public testing::WithParamInterface<Nonsense> {};

TEST_P(Nonsensical, IsRefused) {
  const Nonsense& nonsense = GetParam();
  const auto path = folder_ / "changed.h5";
  rewrite(write(SampleLibrary(3)), path, [](const std::string&, auto&) {});
  HashLibrary(path).verify();
  rewrite(folder_ / "library.h5", path, [&](const std::string& array, auto& bytes) {
    if (array == nonsense.array)
      std::memcpy(bytes.data() + nonsense.byte, nonsense.bytes.data(), nonsense.bytes.size());
  });
  const auto read = [&] {
    const HashLibrary library(path);
    for (int i = 0; i < 3; ++i) library.read_model(i);
    all_postings(library);
  };
  const std::string by_reading = message_of(read);
  const std::string by_verifying = message_of([&] { HashLibrary(path).verify(); });
  EXPECT_NE(by_reading.find(nonsense.message), std::string::npos) << by_reading;
  EXPECT_NE(by_verifying.find(nonsense.message), std::string::npos) << by_verifying;
}

const std::vector<std::uint8_t> kNan = {0, 0, 0xc0, 0x7f};

INSTANTIATE_TEST_SUITE_P(
    Each, Nonsensical,
    testing::Values(
        Nonsense{
            "Code", "/models/features", 38 * 310 + 36, {8}, "model 1 has a feature of no kind"},
        Nonsense{
            "Level", "/models/features", 38 * 899 + 37, {3}, "model 2 has a feature of a level"},
        Nonsense{"Position", "/models/features", 38 * 599 + 4, kNan, "model 1 has numbers that"},
        Nonsense{"Sample", "/models/sample_points", 12 * 700 + 8, kNan, "not finite"},
        Nonsense{"Scale", "/models/level_scales", 4 * 4, kNan, "not finite"},
        Nonsense{"Diagonal", "/models/diagonals", 4, kNan, "model 1 has numbers that"},
        Nonsense{"Centre", "/models/centres", 20, kNan, "model 1 has numbers that"},
        Nonsense{"Spacing", "/models/sample_spacings", 8, kNan, "model 2 has numbers that"},
        Nonsense{
            "FeatureOffsets", "/models/feature_offsets", 8, {0xff, 0xff}, "model 1 ends before"},
        Nonsense{"NegativeOffset", "/models/feature_offsets", 15, {0x80}, "model 0 ends before"},
        Nonsense{"SampleOffsets", "/models/sample_offsets", 24, {0, 9}, "are not from row 0"},
        Nonsense{"LevelOffsets", "/models/level_offsets", 0, {1}, "are not from row 0"},
        Nonsense{"Names", "/models/names", 11, {'9'}, "do not ascend"},
        Nonsense{"TwoNames", "/models/names", 3, {0}, "has not one text for each"},
        Nonsense{"NoLastName", "/models/names", 38, {'x'}, "has not one text for each"},
        Nonsense{"Model", "/postings", 26 * 9 + 16, {3}, "posting 9 is of model 3 of 3"},
        Nonsense{"NegativeModel", "/postings", 26 * 9 + 19, {0x80}, "posting 9 is of model"},
        Nonsense{"Corner", "/postings", 26 * 9 + 25, {0x12}, "posting 9 refers to feature"},
        Nonsense{"Cells", "/cells", 8 * 100000, {0, 0, 0}, "ends before it begins"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(HashLibraryTest, ArraysMustFitOneAnother) {
  const auto good = write(SampleLibrary(3));
  for (const char* array :
       {"/models/names", "/models/digests", "/models/length_units", "/models/centres",
        "/models/origins", "/models/diagonals", "/models/sample_spacings", "/models/triplets",
        "/models/feature_offsets", "/models/level_offsets", "/models/sample_offsets",
        "/models/features", "/models/level_scales", "/models/sample_points",
        "/models/sample_normals", "/postings", "/cells"}) {
    const auto path = folder_ / "short.h5";
    rewrite(good, path, [&](const std::string& name, auto& bytes) {
      if (name == array)
        bytes.resize(bytes.size() -
                     static_cast<std::size_t>(Hdf5File::open(good).shape_of(name).row_bytes()));
    });
    EXPECT_THROW(HashLibrary{path}, Error) << array;
  }
}

TEST_F(HashLibraryTest, WriterRefusesWrongUse) {
  const auto path = folder_ / "library.h5";
  const kernels::RecognitionModel model = tests::generated_model(1, {});
  const LibrarySizes sizes{.models = 2, .features = 600, .level_scales = 6, .samples = 1000};
  const auto write = [&](const std::vector<kernels::RecognitionModel>& models) {
    HashLibraryWriter writer(path, {}, sizes);
    for (const kernels::RecognitionModel& m : models) writer.write_model(pack_model(m), 0);
    writer.finish(std::vector<std::uint64_t>(kernels::kTripletCells + 1));
  };
  const kernels::RecognitionModel next = tests::generated_model(2, {});
  write({model, next});
  std::filesystem::remove(path);
  EXPECT_THROW(write({next, model}), std::invalid_argument) << "order of names";
  EXPECT_THROW(write({model, model}), std::invalid_argument) << "equal names";
  EXPECT_THROW(write({model}), std::invalid_argument) << "too few models";
  kernels::RecognitionModel bad = next;
  bad.features.features[4].code = kernels::kFeatureCodes;
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "code";
  bad = next;
  bad.features.features[4].level = 3;
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "level";
  bad = next;
  bad.samples.normals.pop_back();
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "samples";
  bad = next;
  bad.features.features.pop_back();
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "fewer rows than said";
  bad = next;
  bad.samples.points[7].y() = NAN;
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "not finite";
  bad = next;
  bad.name.push_back('\0');
  EXPECT_THROW(write({model, bad}), std::invalid_argument) << "NUL";
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace semigeo::io
