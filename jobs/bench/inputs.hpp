#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/run_context.hpp"
#include "kernels/surface/surface.hpp"
#include "kernels/surface/triangle_mesh.hpp"

namespace semigeo::jobs {

/// Says how much each case has to do. Numbers of vertices are lower bounds.
struct BenchSizes {
  std::int64_t even_vertices = 20'000;   ///< Surface of a level and a kernel.
  std::int64_t scan_vertices = 12'000;   ///< Built-in surface like a scan.
  std::int64_t large_vertices = 40'000;  ///< The large scan of a job.
  std::int64_t small_vertices = 1'000;   ///< Each of the small scans of a job.
  int small_scans = 16;
  std::int64_t model_vertices = 1'500;  ///< Each model of a library.
  int models = 8;                       ///< Models of the library in which a scene is recognised.
  int library_models = 100;             ///< Models of the library that is built.
  std::int64_t memory_bytes = std::int64_t{48} << 20;  ///< Each of the three arrays of a triad.
  std::int64_t disk_bytes = std::int64_t{16} << 20;    ///< The file that measures the disk.
};

/// Returns the sizes of a full measurement, or those of a quick one.
BenchSizes bench_sizes(bool quick);

/// Numbers the surfaces and sizes that rates belong to. Raise it when one of them changes, because
/// rates of different workloads are not compared.
inline constexpr int kBenchWorkload = 1;

/// Makes and keeps what cases work on. Everything is made when it is first asked for. All files are
/// below one folder. It is used by one thread at a time.
class BenchInputs {
 public:
  /// `folder` must exist and is left behind. `program` is the path of the program `semigeo`.
  /// `scan` takes the place of the built-in surface that is like a scan, unless it is empty.
  BenchInputs(std::filesystem::path folder, std::filesystem::path program,
              std::filesystem::path scan, const BenchSizes& sizes);

  const BenchSizes& sizes() const { return sizes_; }
  const std::filesystem::path& folder() const { return folder_; }
  const std::filesystem::path& program() const { return program_; }
  /// Returns the observer of all work. It does nothing.
  engine::Observer& observer() { return observer_; }

  /// Returns an even surface, closed.
  const kernels::Surface& even_surface();
  /// Returns the surface of the scan.
  const kernels::Surface& scan_surface();
  /// Returns the mesh of the scan as its file has it.
  const kernels::TriangleMesh& scan_mesh();
  /// Returns the file of the scan.
  const std::filesystem::path& scan_file();
  /// Returns the file of a large even scan.
  const std::filesystem::path& large_file();
  /// Returns the folder of the small scans.
  const std::filesystem::path& small_folder();

 private:
  std::filesystem::path folder_;
  std::filesystem::path program_;
  std::filesystem::path scan_file_;
  BenchSizes sizes_;
  engine::Observer observer_;
  std::optional<kernels::TriangleMesh> scan_mesh_;
  std::optional<kernels::Surface> even_surface_;
  std::optional<kernels::Surface> scan_surface_;
  std::filesystem::path large_file_;
  std::filesystem::path small_folder_;
};

/// Writes a mesh as a binary PLY. Throws io::Error if that fails.
void write_mesh(const std::filesystem::path& path, const kernels::TriangleMesh& mesh);

/// Writes a mesh as text, with every digit of its coordinates. Throws io::Error if that fails.
void write_obj(const std::filesystem::path& path, const kernels::TriangleMesh& mesh);

/// Writes a scan's dataset with `levels` smoothings on all workers. Throws io::Error.
void write_dataset(const std::filesystem::path& scan, const std::filesystem::path& dataset,
                   int levels, const engine::RunContext& context);

}  // namespace semigeo::jobs
