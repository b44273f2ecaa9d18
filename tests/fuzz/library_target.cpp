// A library whose arrays, attributes and links are changed, and whose checksums and digest are
// right.
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/files/error.hpp"
#include "io/library/hash_library.hpp"
#include "tests/fuzz/hdf5_tree.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/io/library/sample_library.hpp"

namespace semigeo::fuzz {
namespace {

const Hdf5Tree& original() {
  static const Hdf5Tree tree = [] {
    const std::filesystem::path path = folder() / "original.h5";
    tests::write_library(path,
                         tests::SampleLibrary(3, {.features = 6, .samples = 5, .triplets = 20}));
    return Hdf5Tree(io::Hdf5File::open(path));
  }();
  return tree;
}

template <typename Call>
void attempt(const std::filesystem::path& path, const Call& call) {
  try {
    call();
  } catch (const io::Error& error) {
    check(error.file() == path, "an error names another file");
  }
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  Hdf5Tree tree = original();
  tree.edit(numbers);
  const std::filesystem::path path = folder() / "library.h5";
  try {
    tree.write(path);
  } catch (const std::exception&) {
    return;  // it cannot be written
  }
  attempt(path, [&] { io::library_key(path); });
  attempt(path, [&] {
    const io::HashLibrary library(path);
    library.parameters().dump();
    const auto models = static_cast<std::int64_t>(library.models().size());
    for (std::int64_t block = -1; block * library.block_size() <= library.posting_count(); ++block)
      attempt(path, [&] {
        for (const kernels::Posting& posting : library.read_block(block))
          check(posting.model < models, "a posting is of no model");
      });
    for (std::int64_t model = -1; model <= std::min<std::int64_t>(models, 4); ++model)
      attempt(path, [&] {
        const kernels::RecognitionModel read = library.read_model(model);
        check(read.samples.points.size() == read.samples.normals.size(), "a normal is missing");
      });
    attempt(path, [&] { library.verify(); });
  });
}

}  // namespace semigeo::fuzz
