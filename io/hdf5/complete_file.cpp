#include "io/hdf5/complete_file.hpp"

#include <future>
#include <nlohmann/json.hpp>

#include "io/files/read_error.hpp"
#include "io/files/small_file.hpp"

namespace semigeo::io {
namespace {

void require_format(const Hdf5File& file, const FileFormat& format) {
  if (!file.has_attribute("/", "format") || !file.has_attribute("/", "format_version") ||
      file.read_attribute_as<std::string>("/", "format") != format.name)
    throw Error(file.path(), "", std::string("is an HDF5 file but not a semigeo ") + format.noun,
                format.remedy);
  const auto version = file.read_attribute_as<std::int64_t>("/", "format_version");
  if (version != format.version)
    throw Error(file.path(), "",
                std::string("has ") + format.noun + " format " + std::to_string(version) +
                    ", this program reads " + std::to_string(format.version),
                "use the version of semigeo that made it, or compute it again");
}

}  // namespace

void write_format(DigestedFile& file, const FileFormat& format) {
  file.write_attribute("/", "format", format.name);
  file.write_attribute("/", "format_version", format.version);
  file.write_attribute("/", "creator", "semigeo");
  file.write_attribute("/", "creator_version", SEMIGEO_VERSION);
}

Hdf5File open_complete(const std::filesystem::path& path, const FileFormat& format) {
  Hdf5File file = Hdf5File::open(path);
  require_format(file, format);
  if (!file.has_attribute("/", "complete") ||
      file.read_attribute_as<std::int64_t>("/", "complete") != 1)
    file.refuse("", "was not written to its end");
  return file;
}

nlohmann::json read_json_attribute(const Hdf5File& file, const std::string& name) {
  auto document = parse_json(file.read_attribute_as<std::string>("/", name), {});
  if (document.is_discarded())
    throw Error(file.path(), "attribute " + name, "is not JSON",
                "the file is damaged or not one of semigeo's");
  return document;
}

std::string complete_file(DigestedFile& digested, AtomicFile& target,
                          const std::function<std::string(const std::filesystem::path&)>& verify) {
  std::string digest = digested.digest().hex();
  Hdf5File& file = digested.file();
  file.write_attribute("/", "digest", digest);
  file.flush();
  file.write_attribute("/", "complete", std::int64_t{1});
  file.close();
  // If no thread can be started, get() itself syncs the file.
  std::future<void> synced =
      std::async(std::launch::async | std::launch::deferred, [&] { target.sync(); });
  try {
    if (verify(target.temporary_path()) != digest)
      throw Error(target.final_path(), "", "its digest is not that of what was written");
  } catch (const ReadError& error) {
    throw ReadError(error.code(), target.final_path(), error.place(),
                    "what was just written cannot be read back (" + error.problem() + ")");
  } catch (const Error& error) {
    throw Error(target.final_path(), error.place(),
                "what was just written reads back wrong (" + error.problem() + ")",
                "check the disk and run again");
  }
  synced.get();
  return digest;
}

}  // namespace semigeo::io
