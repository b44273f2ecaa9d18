// A dataset whose arrays, attributes and links are changed, and whose checksums and digest are
// right.
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/dataset/dataset.hpp"
#include "io/dataset/dataset_header.hpp"
#include "io/dataset/xdmf.hpp"
#include "io/files/error.hpp"
#include "jobs/report/scan_report.hpp"
#include "tests/fuzz/hdf5_tree.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/io/dataset/sample_dataset.hpp"

namespace semigeo::fuzz {
namespace {

const Hdf5Tree& original(bool changing) {
  const auto make = [](bool is_changing) {
    const std::filesystem::path path = folder() / "original.vtkhdf";
    tests::write_sample(path, {.levels = is_changing ? 2 : 3,
                               .changing = is_changing,
                               .vertices = is_changing ? 120 : 20,
                               .triangles = is_changing ? 80 : 30});
    return Hdf5Tree(io::Hdf5File::open(path));
  };
  static const Hdf5Tree same = make(false);
  static const Hdf5Tree other = make(true);
  return changing ? other : same;
}

/// Calls something that may throw io::Error.
template <typename Call>
void attempt(const std::filesystem::path& path, const Call& call) {
  try {
    call();
  } catch (const io::Error& error) {
    check(error.file() == path, "an error names another file");
  }
}

void read_level(const io::Dataset& dataset, int level) {
  const std::filesystem::path path = dataset.path();
  attempt(path, [&] { dataset.level(level); });
  attempt(path, [&] { dataset.scale(level); });
  for (const char* name :
       {"points", "normals", "gaussian_curvature", "mean_curvature", "patch_completeness"})
    attempt(path, [&] { dataset.read_floats(level, name); });
  for (const char* name : {"triangles", "source_vertex", "part", "vertex_filled", "face_filled"})
    attempt(path, [&] { dataset.read_integers(level, name); });
  attempt(path, [&] {
    const std::int64_t vertices = dataset.level(level).vertices;
    for (const auto& features : dataset.read_features(level))
      for (const kernels::Feature& feature : features)
        check(feature.vertex >= 0 && feature.vertex < vertices, "a feature is at no vertex");
  });
  for (const auto kind : {kernels::FeatureKind{0}, kernels::FeatureKind{1}})
    attempt(path, [&] { dataset.read_contours(level, kind); });
}

}  // namespace

void read_input(std::string_view bytes) {
  Numbers numbers(bytes);
  Hdf5Tree tree = original(numbers.below(2) != 0);
  tree.edit(numbers);
  const std::filesystem::path path = folder() / "scan.vtkhdf";
  try {
    tree.write(path);
  } catch (const std::exception&) {
    return;  // it cannot be written
  }
  attempt(path, [&] { io::read_origin(path); });
  attempt(path, [&] { io::sidecar_text(path); });
  attempt(path, [&] {
    const io::Dataset dataset(path);
    for (int level = 0; level < std::min(dataset.level_count(), 4); ++level)
      read_level(dataset, level);
    attempt(path, [&] { dataset.selection(); });
    attempt(path, [&] { jobs::scan_report(dataset).dump(); });
    attempt(path, [&] { dataset.verify(); });
  });
}

}  // namespace semigeo::fuzz
