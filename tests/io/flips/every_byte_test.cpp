// Whatever byte of an output is wrong: it is noticed, or the answer is what it was. Slow, because
// every byte is one reading of the file.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "engine/fork_child.hpp"
#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "io/library/hash_library.hpp"
#include "io/library/hash_library_format.hpp"
#include "io/library/posting_partition.hpp"
#include "io/library/triplet_run.hpp"
#include "kernels/recognition/triplet.hpp"
#include "tests/io/dataset/sample_dataset.hpp"
#include "tests/io/library/sample_library.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::io {
namespace {

namespace fs = std::filesystem;

/// Collects all that a reader says, as one digest.
class Answer {
 public:
  template <typename Value>
  Answer& operator<<(const std::vector<Value>& values) {
    text_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
    return *this;
  }
  Answer& operator<<(const std::string& text) {
    text_ += text + '\0';
    return *this;
  }
  template <typename Value>
  requires std::is_arithmetic_v<Value> Answer& operator<<(Value value) {
    text_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  std::string digest() const { return xxh3_of_text(text_); }

 private:
  std::string text_;
};

std::string answer_of_dataset(const fs::path& path) {
  const Dataset dataset(path);
  dataset.verify();
  const DatasetOrigin origin = read_origin(path);
  Answer answer;
  answer << dataset.digest() << origin.job_key << origin.input_xxh3 << origin.parameters_json
         << origin.creator_version << dataset.level_count() << dataset.selection().level;
  for (int k = 0; k < dataset.level_count(); ++k) {
    const LevelInfo level = dataset.level(k);
    answer << level.scale << level.vertices << level.triangles;
    for (const char* name :
         {"points", "normals", "gaussian_curvature", "mean_curvature", "patch_completeness"})
      answer << dataset.read_floats(k, name);
    for (const char* name : {"triangles", "source_vertex", "part"})
      answer << dataset.read_integers(k, name);
    for (const auto& features : dataset.read_features(k))
      for (const kernels::Feature& feature : features)
        answer << feature.vertex << feature.value << feature.prominence;
  }
  return answer.digest();
}

std::string answer_of_library(const fs::path& path) {
  const HashLibrary library(path);
  library.verify();
  Answer answer;
  answer << library.digest() << library.parameters().dump();
  answer << std::vector(library.cells().begin(), library.cells().end());
  const std::int64_t blocks =
      (library.posting_count() + library.block_size() - 1) / library.block_size();
  for (std::int64_t b = 0; b < blocks; ++b)
    for (const kernels::Posting& posting : library.read_block(b))
      answer << posting.model << posting.corners[0] << posting.corners[1] << posting.corners[2];
  for (std::size_t m = 0; m < library.models().size(); ++m) {
    const kernels::RecognitionModel model = library.read_model(static_cast<std::int64_t>(m));
    answer << library.models()[m].name << model.digest << model.length_unit << model.diagonal
           << model.samples.points << model.samples.normals;
  }
  return answer.digest();
}

std::string answer_of_run(const fs::path& path) {
  const TripletRun run(path);
  const kernels::RecognitionModel model = run.read_model();
  Answer answer;
  answer << run.job_key() << run.name() << model.digest << model.length_unit << model.diagonal
         << model.samples.points << model.samples.normals << run.read_triplets();
  return answer.digest();
}

std::string answer_of_partition(const fs::path& path) {
  const PostingPartition partition(path);
  Answer answer;
  answer << partition.header().job_key << partition.header().models << partition.header().runs_hash
         << std::vector(partition.cell_counts().begin(), partition.cell_counts().end());
  for (std::int64_t b = 0; b < partition.blocks(); ++b) answer << partition.read_block(b);
  return answer.digest();
}

class EveryByte : public testing::Test {
 protected:
  using AnswerOf = std::string (*)(const fs::path&);

  /// Flips a bit of every `stride`th byte.
  void flip(std::size_t stride, AnswerOf answer_of) {
    std::stringstream bytes;
    bytes << std::ifstream(path_, std::ios::binary).rdbuf();
    good_ = bytes.str();
    expected_ = answer_of(path_);
    for (std::size_t at = 0; at < good_.size();) at = read_mutants(at, stride, answer_of);
    RecordProperty("flips", std::to_string(flips_));
    RecordProperty("crashes", std::to_string(crashes_));
  }

  tests::TemporaryFolder folder_;
  fs::path path_ = folder_ / "file";

 private:
  /// Reads some mutants in a child process, because HDF5 crashes on some of them, and reads others
  /// for ever. There, that is one failed job, which names the file. Returns the next byte to flip.
  std::size_t read_mutants(std::size_t begin, std::size_t stride, AnswerOf answer_of) {
    constexpr std::size_t kMutants = 512;
    constexpr double kSeconds = 10;
    const std::size_t end = std::min(begin + kMutants * stride, good_.size());
    const fs::path progress = folder_ / "progress";
    const auto work = [&] {
      std::string findings;
      for (std::size_t at = begin; at < end; at += stride) {
        std::ofstream(progress) << at;
        findings += finding(at, answer_of);
      }
      return findings;
    };
    const engine::ForkedResult result = engine::ForkedChild(work, kSeconds).wait();
    std::size_t last = end;
    if (result.exit_code == 0) {
      EXPECT_EQ(result.text, "");
    } else {
      std::ifstream(progress) >> last;
      ++crashes_;
      ++last;
    }
    const std::size_t flips = (last - begin + stride - 1) / stride;
    flips_ += flips;
    return begin + flips * stride;
  }

  /// Returns what is wrong about a mutant, or an empty text.
  std::string finding(std::size_t at, AnswerOf answer_of) const {
    std::string bad = good_;
    bad[at] = static_cast<char>(bad[at] ^ 1 << at % 8);
    std::ofstream(path_, std::ios::binary) << bad;
    try {
      return answer_of(path_) == expected_ ? "" : "byte " + std::to_string(at) + ": not noticed\n";
    } catch (const Error&) {
      return "";
    } catch (const std::exception& other) {
      return "byte " + std::to_string(at) + ": " + other.what() + '\n';
    }
  }

  std::string good_;
  std::string expected_;
  std::size_t flips_ = 0;
  std::size_t crashes_ = 0;
};

TEST_F(EveryByte, OfADataset) {
  tests::write_sample(path_, {.levels = 2, .vertices = 40, .triangles = 60});
  flip(1, answer_of_dataset);
}

TEST_F(EveryByte, OfALibrary) {
  const tests::SampleLibrary sample(2, {.features = 10, .samples = 20, .triplets = 30});
  tests::write_library(path_, sample);
  flip(13, answer_of_library);
}

TEST_F(EveryByte, OfARun) {
  const tests::ModelSize size{.features = 10, .samples = 20, .triplets = 30};
  const kernels::RecognitionModel model = tests::generated_model(3, size);
  write_triplet_run(path_, "key", model, tests::generated_triplets(3, model, size));
  flip(1, answer_of_run);
}

TEST_F(EveryByte, OfAPartition) {
  std::vector<std::uint32_t> counts(3 * kernels::kCodeTriples);
  counts.back() = 100;
  PostingPartitionWriter writer(
      path_, {.job_key = "key", .shapes = {7, 10}, .models = 4, .runs_hash = 17});
  writer.add(std::vector<std::byte>(100 * kPostingBytes, std::byte{17}));
  writer.finish(counts);
  flip(1, answer_of_partition);
}

}  // namespace
}  // namespace semigeo::io
