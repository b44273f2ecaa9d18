#include <cstring>
#include <iterator>
#include <span>

#include "io/library/hash_library_format.hpp"
#include "io/library/packed_rows.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "tests/fuzz/seed_folder.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/io/scans/gltf_files.hpp"
#include "tests/io/scans/scan_files.hpp"
#include "tests/io/scans/scan_seeds.hpp"
#include "tests/support/containers.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::fuzz {
namespace {

namespace fs = std::filesystem;

std::string bytes_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void make_scans(const fs::path& folder) {
  for (const io::Seed& seed : io::plain_seeds())
    put_seed(folder, fs::path(seed.name).extension().string().substr(1), seed.name, seed.bytes);
}

/// Makes compressed texts, and containers of some scans.
void make_packed(const fs::path& folder) {
  const tests::TemporaryFolder work;
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string text = off + std::string(200, '\n') + off;
  for (const char* filter : {"gzip", "bzip2", "xz", "zstd"}) {
    const fs::path file =
        tests::write_container(work / filter, "raw", {{.name = "a.off", .bytes = text}}, filter);
    const std::string bytes = bytes_of_file(file);
    put_seed(folder, "compressed", filter, bytes);
    put_seed(folder, "compressed", std::string(filter) + "_twice", bytes + bytes);
    put_seed(folder, "off", filter, bytes);
  }
  const std::vector<tests::NewMember> members = {{.name = "a/b.off", .bytes = off},
                                                 {.name = "../c.txt", .bytes = "text"},
                                                 {.name = "d.off", .link = "a/b.off"},
                                                 {.name = "e é.off", .bytes = text}};
  struct Format {
    const char* name;
    const char* format;
    const char* filter;
    const char* options;
  };
  for (const Format& f :
       {Format{"zip", "zip", "", ""}, Format{"stored", "zip", "", "zip:compression=store"},
        Format{"7z", "7zip", "", ""}, Format{"7z_copy", "7zip", "", "7zip:compression=store"},
        Format{"pax", "pax", "", ""}, Format{"ustar", "ustar", "", ""},
        Format{"gnu", "gnutar", "", ""}, Format{"tgz", "pax", "gzip", ""},
        Format{"tzst", "pax", "zstd", ""}}) {
    const fs::path file =
        tests::write_container(work / f.name, f.format, members, f.filter, f.options);
    put_seed(folder, "container", f.name, "1" + bytes_of_file(file));
  }
}

/// Makes a run of triplets and a partition of postings.
void make_library_parts(const fs::path& folder) {
  const tests::TemporaryFolder work;
  const tests::SampleLibrary sample(2, {.features = 6, .samples = 4, .triplets = 8});
  io::write_triplet_run(work / "run", "key", sample.models[0], sample.triplets[0]);
  put_seed(folder, "triplets", "run", bytes_of_file(work / "run"));
  const io::ShapeRange shapes = {.first = kernels::kShapes / 2, .end = kernels::kShapes / 2 + 1};
  std::vector<std::uint32_t> counts;
  std::size_t first = sample.cells[shapes.first_cell()];
  for (std::uint32_t cell = shapes.first_cell(); cell < shapes.end_cell(); ++cell)
    counts.push_back(static_cast<std::uint32_t>(sample.cells[cell + 1] - sample.cells[cell]));
  const std::size_t count = sample.cells[shapes.end_cell()] - first;
  io::PostingPartitionWriter writer(
      work / "part", {.job_key = "key", .shapes = shapes, .models = 2, .runs_hash = 7});
  writer.add(io::packed(std::span(sample.postings).subspan(first, count), io::kPostingBytes));
  writer.finish(counts);
  put_seed(folder, "partition", "part", bytes_of_file(work / "part"));
}

/// Makes chunks behind the numbers that chunk_target.cpp reads.
void make_chunks(const fs::path& folder) {
  std::vector<float> values(32);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 5);
  for (const bool deflate : {false, true}) {
    const io::ArrayShape shape = {
        .rows = 32,
        .chunk_rows = 32,
        .compression = deflate ? io::Compression::kDeflate : io::Compression::kNone};
    const io::EncodedChunk chunk = io::encode_rows(shape, std::as_bytes(std::span(values)));
    std::string bytes = {0, 0, 31, static_cast<char>(deflate), static_cast<char>(chunk.filter_mask),
                         1};
    bytes.append(reinterpret_cast<const char*>(chunk.bytes.data()), chunk.bytes.size() - 4);
    put_seed(folder, "chunk", deflate ? "deflate" : "none", bytes);
  }
}

}  // namespace

void put_seed(const fs::path& folder, const std::string& target, const std::string& name,
              const std::string& bytes) {
  fs::create_directories(folder / target);
  io::write_file(folder / target / name, bytes);
}

void make_file_seeds(const fs::path& folder) {
  make_scans(folder);
  make_packed(folder);
  make_library_parts(folder);
  make_chunks(folder);
}

}  // namespace semigeo::fuzz
