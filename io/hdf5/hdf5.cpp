#include "io/hdf5/hdf5.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/write_error.hpp"
#include "io/hdf5/hdf5_library.hpp"

namespace semigeo::io {
namespace {

constexpr const char* kDamaged =
    "the file is damaged or not one of semigeo's: remove it and run again, or run with --verify";

constexpr unsigned kMostInHeader = 48;

/// The cause of an error: HDF5's words or the system's, and the system's errno or 0.
struct InnermostReason {
  std::string text;
  int code = 0;
};

/// Holds HDF5's description of an error.
struct Reason {
  std::optional<std::string> text = "";  ///< It is empty if there was no memory for it.
  bool lacks_memory = false;             ///< HDF5 got no memory.
};

/// Keeps the description of the innermost entry, with which the walk begins.
herr_t keep_innermost(unsigned index, const H5E_error2_t* error, void* data) noexcept {
  auto& reason = *static_cast<Reason*>(data);
  if (error->maj_num == H5E_RESOURCE || error->min_num == H5E_NOSPACE) reason.lacks_memory = true;
  if (index > 0 || error->desc == nullptr) return 0;
  try {
    reason.text = error->desc;
  } catch (const std::bad_alloc&) {
    reason.text.reset();
  }
  return 0;
}

/// Returns an empty list of properties.
Hdf5Handle properties_of(hid_t type) {
  return {in_memory(H5Pcreate(type)), H5Pclose};
}

Hdf5Handle file_access() {
  Hdf5Handle access = properties_of(H5P_FILE_ACCESS);
  in_memory(H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_V110));
  in_memory(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG));
  // Files get their names when they are whole and are never changed in place, so locks would
  // protect nothing. With locks, files could not be opened on network file systems that have none.
  in_memory(H5Pset_file_locking(access.get(), false, true));
  return access;
}

// Groups store no times. Up to kMostInHeader entries or attributes lie in the group's header; with
// more, a group gets a heap and an index of some kB.
void prepare_group(hid_t properties) {
  in_memory(H5Pset_obj_track_times(properties, false));
  in_memory(H5Pset_link_phase_change(properties, kMostInHeader, kMostInHeader / 2));
  in_memory(H5Pset_attr_phase_change(properties, kMostInHeader, kMostInHeader / 2));
}

herr_t collect_link(hid_t, const char* name, const H5L_info_t* info, void* data) noexcept {
  try {
    static_cast<std::vector<Hdf5Link>*>(data)->push_back(
        {name, Hdf5Link::Kind::kOther, info->type == H5L_TYPE_HARD ? info->u.address : 0});
    return 0;
  } catch (...) {
    return -1;
  }
}

}  // namespace

// HDF5's exit handler is turned off. It would flush what a full disk has left unwritten, and crash.
// H5open does not report each allocation that has failed.
static bool has_started() {
  errno = 0;
  H5dont_atexit();  // fails if the library runs already, as in programs that also use it directly
  return H5open() >= 0 && errno != ENOMEM;
}

// HDF5 starts once for each process. If it gets no memory then, it stays half started, and later
// calls would take that for damage. Once for each thread, the printing of HDF5's error stack is
// turned off.
void prepare_library() {
  static const bool started = has_started();
  if (!started) throw std::bad_alloc();
  thread_local const int quiet = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  static_cast<void>(quiet);
}

void start_hdf5() {
  prepare_library();
}

// Whether HDF5 got no memory once in this process. It may be broken since then, so that what it
// says of a file is no proof of damage.
static std::atomic<bool> has_lacked_memory = false;

// Returns the errno of the last call of the system that has failed in this thread since the last
// file was opened, and forgets it. It is 0 if that error does not keep files from being read. HDF5
// mostly does not tell it: it reports what it could not find or do then.
static int refusal_of_system() {
  switch (const int code = std::exchange(errno, 0)) {
    case ENOMEM:
    case EIO:
    case EACCES:
    case EPERM:
    case EMFILE:
    case ENFILE:
    case ESTALE:
    case ETIMEDOUT:
      return code;
    default:
      return has_lacked_memory ? ENOMEM : 0;
  }
}

// Returns HDF5's innermost reason. From a report about a system call it takes only the words of the
// system and the number of its error, which HDF5 has nowhere else.
static InnermostReason reason_and_code() {
  const int refusal = refusal_of_system();
  Reason reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &reason);
  if (!reason.text) throw std::bad_alloc();  // no exception may pass through a C library
  std::string text = std::move(*reason.text);
  if (reason.lacks_memory) has_lacked_memory = true;
  int code = reason.lacks_memory ? ENOMEM : refusal;
  constexpr std::string_view kNumber = "errno = ";
  if (const std::size_t number = text.find(kNumber); number != std::string::npos)
    std::from_chars(text.data() + number + kNumber.size(), text.data() + text.size(), code);
  constexpr std::string_view kMark = "error message = '";
  const std::size_t mark = text.find(kMark);
  if (mark != std::string::npos) {
    const std::size_t begin = mark + kMark.size();
    text = text.substr(begin, text.find('\'', begin) - begin);
  }
  return {text.empty() ? "HDF5 gives no reason" : text, code};
}

std::string innermost_reason() {
  return reason_and_code().text;
}

void Hdf5File::fail(const std::string& place, const std::string& action) const {
  const auto [reason, code] = reason_and_code();
  const std::string problem = "cannot " + action + ": " + reason;
  if (!writing_ && code != 0) throw ReadError(code, shown_as_, place, problem);
  if (!writing_) throw Error(shown_as_, place, problem, kDamaged);
  throw WriteError(code, shown_as_, place, problem,
                   code == ENOSPC ? "free some space and run again"
                                  : "check the disk and the memory, and run again");
}

void Hdf5File::refuse(const std::string& place, const std::string& problem) const {
  const int refusal = refusal_of_system();
  if (refusal == ENOMEM)
    throw ReadError(refusal, shown_as_, place, "there was no memory to read it");
  if (refusal == EIO) throw ReadError(refusal, shown_as_, place, "the disk refused to read it");
  throw Error(shown_as_, place, problem, kDamaged);
}

std::int64_t Hdf5File::checked(std::int64_t result, const std::string& place,
                               const char* action) const {
  if (result < 0) fail(place, action);
  return result;
}

std::int64_t Hdf5File::id() const {
  prepare_library();
  return handle_.get();
}

Hdf5File Hdf5File::create(const std::filesystem::path& file,
                          const std::filesystem::path& shown_as) {
  prepare_library();
  const Hdf5Handle creation = properties_of(H5P_FILE_CREATE);
  prepare_group(creation.get());
  const Hdf5Handle access = file_access();
  Hdf5File result({}, shown_as.empty() ? file : shown_as, true);
  result.handle_ = Hdf5Handle(
      result.checked(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), "",
                     "create it"),
      H5Fclose);
  return result;
}

Hdf5File Hdf5File::open(const std::filesystem::path& file, const std::filesystem::path& shown_as) {
  prepare_library();
  errno = 0;
  const Hdf5Handle access = file_access();
  Hdf5File result({}, shown_as.empty() ? file : shown_as, false);
  result.handle_ = Hdf5Handle(
      result.checked(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.get()), "", "open it"), H5Fclose);
  return result;
}

void Hdf5File::create_group(const std::string& path) {
  const Entry place = entry(path);
  const Hdf5Handle properties = properties_of(H5P_GROUP_CREATE);
  prepare_group(properties.get());
  Hdf5Handle group(
      checked(H5Gcreate2(place.group, place.name, H5P_DEFAULT, properties.get(), H5P_DEFAULT), path,
              "create the group"),
      H5Oclose);
  checked(opened_.close(), opened_path_, "close the object");
  opened_ = std::move(group);
  opened_path_ = path;
}

void Hdf5File::link(const std::string& existing, const std::string& path) {
  const Entry place = entry(path);
  checked(H5Lcreate_hard(handle_.get(), existing.c_str(), place.group, place.name, H5P_DEFAULT,
                         H5P_DEFAULT),
          path, "create the link");
  const auto known = arrays_.find(existing);
  if (known != arrays_.end()) arrays_.emplace(path, known->second);
}

void Hdf5File::flush() {
  checked(H5Fflush(id(), H5F_SCOPE_LOCAL), "", "flush it");
}

void Hdf5File::close() {
  prepare_library();
  checked(opened_.close(), std::exchange(opened_path_, ""), "close the object");
  checked(handle_.close(), "", "close it");
}

std::int64_t Hdf5File::opened(const std::string& path) const {
  const std::int64_t file = id();
  if (path.empty() || path == "/") return file;
  if (path != opened_path_) {
    checked(opened_.close(), std::exchange(opened_path_, ""), "close the object");
    opened_ = Hdf5Handle(checked(H5Oopen(file, path.c_str(), H5P_DEFAULT), path, "open the object"),
                         H5Oclose);
    opened_path_ = path;
  }
  return opened_.get();
}

Hdf5File::Entry Hdf5File::entry(const std::string& path) const {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {id(), path.c_str()};
  return {opened(path.substr(0, slash)), path.c_str() + slash + 1};
}

bool Hdf5File::has(const std::string& path) const {
  if (path.empty() || path == "/" || path == opened_path_ || arrays_.contains(path)) return true;
  if (!has(path.substr(0, path.rfind('/')))) return false;
  const Entry place = entry(path);
  return checked(H5Lexists(place.group, place.name, H5P_DEFAULT), path, "look for it") > 0;
}

std::vector<Hdf5Link> Hdf5File::links(const std::string& group) const {
  const std::int64_t place = opened(group);
  std::vector<Hdf5Link> result;
  checked(H5Literate(place, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_link, &result), group,
          "list the group");
  for (Hdf5Link& entry : result) {
    if (entry.address == 0) continue;  // a soft or external link
    H5O_info_t info;
    checked(H5Oget_info_by_name2(place, entry.name.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT),
            (group == "/" ? "" : group) + "/" + entry.name, "open the object");
    if (info.type == H5O_TYPE_GROUP) entry.kind = Hdf5Link::Kind::kGroup;
    if (info.type == H5O_TYPE_DATASET) entry.kind = Hdf5Link::Kind::kArray;
  }
  std::ranges::sort(result, {}, &Hdf5Link::name);
  return result;
}

std::uint64_t Hdf5File::address(const std::string& path) const {
  H5O_info_t info;
  checked(H5Oget_info_by_name2(id(), path.c_str(), &info, H5O_INFO_BASIC, H5P_DEFAULT), path,
          "open the object");
  return info.addr;
}

}  // namespace semigeo::io
