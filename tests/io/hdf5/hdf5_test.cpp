#include "io/hdf5/hdf5.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/hdf5/array_reader.hpp"
#include "io/hdf5/complete_file.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

// HDF5 forgets the memory of a file whose closing failed, as the tests with a full disk provoke.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libhdf5";
}

namespace semigeo::io {
namespace {

EncodedArray encode(const std::vector<float>& values) {
  return encode_array(array_of(values), Compression::kDeflate);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

bool mentions(const std::string& message, const std::string& text) {
  return message.find(text) != std::string::npos;
}

TEST(Hdf5, AttributesOfEveryTypeComeBack) {
  const tests::TemporaryFolder folder;
  const std::vector<std::pair<std::string, AttributeValue>> attributes = {
      {"integer", std::int64_t{-7}},
      {"real", 0.1},
      {"text", std::string("text")},
      {"umlaut", std::string("Größe")},
      {"empty", std::string()},
      {"integers", std::vector<std::int64_t>{1, 2, 3}},
      {"one integer", std::vector<std::int64_t>{1}},
      {"reals", std::vector<double>{0.5, -1e300}},
  };
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  for (const auto& [name, value] : attributes) file.write_attribute("/", name, value);
  file.close();

  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(read.attributes("/").size(), attributes.size());
  for (const auto& [name, value] : attributes) {
    EXPECT_EQ(read.read_attribute("/", name), value) << name;
    EXPECT_EQ(read.attribute_type("/", name), attribute_type(value)) << name;
  }
  EXPECT_EQ(read.attribute_type("/", "umlaut"), "utf8[7]");
  EXPECT_FALSE(read.has_attribute("/", "other"));
  EXPECT_TRUE(mentions(message_of([&] { read.read_attribute("/", "other"); }), "attribute other"));
}

TEST(Hdf5, LongAttributesAreRefused) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.write_attribute("/", "long", std::string(60000, 'x'));
  EXPECT_THROW(file.write_attribute("/", "longer", std::string(70000, 'x')), Error);
}

TEST(Hdf5, TextThatIsNotUtf8IsNamedWithItsFile) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.write_attribute("/", "bytes", std::string("a\xff"));
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  const std::string message = message_of([&] { read.read_attribute("/", "bytes"); });
  EXPECT_TRUE(
      message.starts_with((folder / "a.h5").string() + ": /, attribute bytes: is no UTF-8 text"))
      << message;
}

TEST(Hdf5, ListsGroupsArraysAndLinks) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.create_group("/b");
  file.create_group("/b/c");
  file.write_array("/b/z", encode({1, 2}));
  file.link("/b/z", "/b/a");
  file.close();

  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  const std::vector<Hdf5Link> links = read.links("/b");
  ASSERT_EQ(links.size(), 3U);
  EXPECT_EQ(links[0].name, "a");
  EXPECT_EQ(links[1].name, "c");
  EXPECT_EQ(links[1].kind, Hdf5Link::Kind::kGroup);
  EXPECT_EQ(links[2].kind, Hdf5Link::Kind::kArray);
  EXPECT_EQ(links[0].address, links[2].address);
  EXPECT_EQ(links[0].address, read.address("/b/a"));
  EXPECT_TRUE(read.has("/b/c"));
  EXPECT_FALSE(read.has("/b/d"));
  EXPECT_FALSE(read.has("/x/y/z"));
}

// Small groups lie in their object header, others in a heap with an index.
TEST(Hdf5, GroupsMayHaveManyEntriesAndAttributes) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.create_group("/g");
  for (std::int64_t i = 0; i < 200; ++i) {
    file.create_group("/g/" + std::to_string(i));
    file.write_attribute("/g", std::to_string(i), i);
  }
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(read.links("/g").size(), 200U);
  EXPECT_EQ(read.read_attribute_as<std::int64_t>("/g", "123"), 123);
  EXPECT_EQ(read.attributes("/g").size(), 200U);
  EXPECT_EQ(read.read_attribute_as<std::int64_t>("/g", "123"), 123);
  EXPECT_FALSE(read.has_attribute("/g", "200"));
  EXPECT_TRUE(read.has("/g/199"));
  EXPECT_FALSE(read.has("/g/200"));
  EXPECT_FALSE(read.has("/h/199"));
}

TEST(Hdf5, SmallArraysAreReadOnce) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  const EncodedArray array = encode({1, 2, 3});
  file.write_array("/a", array);
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(read.shape_of("/a"), array.shape);
  EXPECT_EQ(read_floats(read, "/a", 1), (std::vector<float>{1, 2, 3}));
  std::ofstream(folder / "a.h5") << "gone";
  EXPECT_EQ(read_floats(read, "/a", 1), (std::vector<float>{1, 2, 3}));
}

TEST(Hdf5, VirtualArraysShowTheirSourcesOneAfterTheOther) {
  const tests::TemporaryFolder folder;
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {4, 5, 6}};
  const EncodedArray rows = encode_array(array_of(std::span(points)), Compression::kNone);
  const std::vector<VirtualPiece> as_rows = {{"/p", 2}, {"/q", 2}};
  const std::vector<VirtualPiece> as_column = {{"/q", 6}, {"/p", 6}};
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.write_array("/p", rows);
  file.write_array("/q", rows);
  file.write_virtual("/rows", ElementType::kFloat32, 3, as_rows);
  file.write_virtual("/column", ElementType::kFloat32, 1, as_column);
  file.close();

  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  std::vector<std::byte> wanted = read.read_through_library("/p");
  EXPECT_EQ(wanted.size(), 24U);
  wanted.insert(wanted.end(), wanted.begin(), wanted.begin() + 24);
  EXPECT_EQ(read.read_through_library("/rows"), wanted);
  EXPECT_EQ(read.read_through_library("/column"), wanted);
  EXPECT_TRUE(read.open_array("/rows").is_virtual());
  EXPECT_EQ(read.open_array("/rows").virtual_pieces(), as_rows);
  EXPECT_EQ(read.open_array("/column").virtual_pieces(), as_column);
}

TEST(Hdf5, ReadersRefuseOtherShapesAndTypes) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  file.write_array("/a", encode({1, 2, 3}));
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_EQ(read_floats(read, "/a", 1), (std::vector<float>{1, 2, 3}));
  EXPECT_TRUE(mentions(message_of([&] { read_floats(read, "/a", 3); }), "1 columns instead of 3"));
  EXPECT_TRUE(mentions(message_of([&] { read_integers(read, "/a", 1); }), "float32 instead of"));
  EXPECT_TRUE(mentions(message_of([&] { read_records(read, "/a", ElementType::kFeature); }),
                       "float32 instead of {vertex:int64,"));
  EXPECT_TRUE(mentions(message_of([&] { read_floats(read, "/b", 1); }), "/b"));
}

TEST(Hdf5, EveryChunkMustBeThere) {
  const tests::TemporaryFolder folder;
  EncodedArray array = encode(std::vector<float>(100000, 1));
  array.chunks.pop_back();
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  EXPECT_THROW(file.write_array("/a", array), std::invalid_argument);
}

TEST(Hdf5, ArraysGrowBesideOneAnotherWhetherCompactOrNot) {
  const tests::TemporaryFolder folder;
  const std::vector<float> values(100000, 0.5F);
  const EncodedArray large = encode(values);
  const EncodedArray small = encode({1, 2, 3});
  ASSERT_TRUE(!large.shape.compact && large.chunks.size() == 2 && small.shape.compact);
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  Hdf5File::Growing chunked = file.begin_array("/chunked", large.shape);
  Hdf5File::Growing compact = file.begin_array("/compact", small.shape);
  chunked.write_chunk(large.chunks[0]);
  EXPECT_THROW(compact.close(), std::invalid_argument) << "it has no rows";
  compact.write_chunk(small.chunks[0]);
  EXPECT_THROW(compact.write_chunk(small.chunks[0]), std::invalid_argument);
  chunked.write_chunk(large.chunks[1]);
  compact.close();
  chunked.close();
  EXPECT_EQ(read_floats(file, "/compact", 1), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(read_floats(file, "/chunked", 1), values);
  Hdf5File::Growing torn = file.begin_array("/torn", small.shape);
  EXPECT_THROW(torn.write_chunk({.bytes = std::vector<std::byte>(8)}), std::invalid_argument);
  file.close();

  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  EXPECT_TRUE(read.shape_of("/compact").compact);
  EXPECT_EQ(read_floats(read, "/compact", 1), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(read_floats(read, "/chunked", 1), values);
}

TEST(Hdf5, PromisesWithoutBytesAllocateNothing) {
  const tests::TemporaryFolder folder;
  const EncodedArray honest = encode(std::vector<float>(60000, 1));
  const auto write = [&](Hdf5File& file, const std::string& path, std::int64_t rows,
                         std::int64_t chunk_rows) {
    EncodedArray array;
    array.shape = {ElementType::kFloat32, rows, 1, chunk_rows, Compression::kDeflate};
    array.chunks.resize(static_cast<std::size_t>(array.shape.chunk_count()), honest.chunks[0]);
    file.write_array(path, array);
  };
  Hdf5File file = Hdf5File::create(folder / "a.h5");
  write(file, "/rows", std::int64_t{1} << 33, std::int64_t{1} << 22);
  write(file, "/chunk", std::int64_t{1} << 30, std::int64_t{1} << 29);
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "a.h5");
  const std::string rows = message_of([&] { read_floats(read, "/rows", 1); });
  EXPECT_TRUE(mentions(rows, "promises 8589934592 rows but stores only")) << rows;
  const std::string chunk = message_of([&] { read_floats(read, "/chunk", 1); });
  EXPECT_TRUE(mentions(chunk, "chunks are too large")) << chunk;
}

TEST(Hdf5, ErrorsNameTheFileAndHdf5sReason) {
  const tests::TemporaryFolder folder;
  const std::string missing = message_of([&] { Hdf5File::open(folder / "missing.h5"); });
  EXPECT_TRUE(mentions(missing, (folder / "missing.h5").string())) << missing;
  EXPECT_TRUE(mentions(missing, "No such file or directory")) << missing;

  std::ofstream(folder / "text.h5") << "this is not HDF5";
  const std::string text = message_of([&] { Hdf5File::open(folder / "text.h5"); });
  EXPECT_TRUE(mentions(text, "signature not found")) << text;

  Hdf5File file = Hdf5File::create(folder / "hidden.h5", folder / "shown.h5");
  const std::string twice = message_of([&] {
    file.create_group("/a");
    file.create_group("/a");
  });
  EXPECT_TRUE(mentions(twice, "shown.h5: /a: ")) << twice;
}

TEST(Hdf5, WhatTheSystemRefusedIsNotDamaged) {
  const tests::TemporaryFolder folder;
  Hdf5File::create(folder / "a.h5").close();
  const Hdf5File file = Hdf5File::open(folder / "a.h5");
  for (const int code : {ENOMEM, EIO}) {
    errno = code;  // as a call within HDF5 leaves it
    EXPECT_THROW(file.refuse("/a", "is not what it was"), ReadError);
  }
  const std::string missing = message_of([&] { file.links("/gone"); });
  EXPECT_TRUE(mentions(missing, "is damaged")) << missing;
  errno = EIO;
  EXPECT_THROW(file.links("/gone"), ReadError);
  EXPECT_THROW(file.links("/gone"), Error);  // the errno is forgotten
  errno = ENOENT;
  EXPECT_TRUE(mentions(message_of([&] { file.refuse("/a", "is odd"); }), "is damaged"));
}

TEST(Hdf5, PrintsNothingInAnyThread) {
  testing::internal::CaptureStderr();
  const auto fails = [] { EXPECT_THROW(Hdf5File::open("/nonexistent/a.h5"), Error); };
  fails();
  std::thread(fails).join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// HDF5 crashed at the exit of a process in which closing a file had failed. If it does again, this
// test passes but its program does not.
TEST(Hdf5, FullDiskIsAnErrorAndTheProcessGoesOn) {
  const tests::TemporaryFolder folder;
  const EncodedArray array = encode(std::vector<float>(300000, 0.1F));
  EncodedArray raw = encode_array(array_of(std::vector<float>(300000)), Compression::kNone);
  {
    const tests::FileSizeLimit limit(100'000);
    Hdf5File file = Hdf5File::create(folder / "full.h5");
    const std::string message = message_of([&] { file.write_array("/a", raw); });
    EXPECT_TRUE(mentions(message, "full.h5: /a: ")) << message;
    EXPECT_TRUE(mentions(message, "File too large")) << message;
    EXPECT_THROW(file.close(), Error);
  }
  Hdf5File file = Hdf5File::create(folder / "other.h5");
  file.write_array("/a", array);
  EXPECT_NO_THROW(file.close());
}

/// JSON is copied and compared bracket by bracket, on the stack.
TEST(CompleteFileTest, AttributesWithBracketsDeepInEachOtherAreNoJson) {
  const tests::TemporaryFolder folder;
  Hdf5File file = Hdf5File::create(folder / "file");
  const std::string deep = "{\"a\":" + std::string(30'000, '[') + std::string(30'000, ']') + "}";
  file.write_attribute("/", "deep", deep);
  file.write_attribute("/", "flat", "{\"a\":[1]}");
  file.close();
  const Hdf5File read = Hdf5File::open(folder / "file");
  EXPECT_EQ(read_json_attribute(read, "flat").at("a").at(0), 1);
  EXPECT_THROW(read_json_attribute(read, "deep"), Error);
}

}  // namespace
}  // namespace semigeo::io
