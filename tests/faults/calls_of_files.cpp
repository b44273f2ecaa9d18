// Calls that concern files and folders. System calls are made directly, because these functions
// stand in the place of those that make them.

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "tests/faults/counted_calls.hpp"

using namespace semigeo::faults;

namespace {

int open_at(int folder, const char* path, int flags, mode_t mode) {
  if (fails(kOpen, path)) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

mode_t mode_of(int flags, va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  const ssize_t moved = transfer(kWrite, kPipeWrite, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_write, descriptor, bytes, moved);
}

ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off64_t offset) {
  const ssize_t moved = transfer(kPwrite, kPwrite, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_pwrite64, descriptor, bytes, moved, offset);
}

ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t offset) {
  return pwrite64(descriptor, bytes, size, offset);
}

ssize_t read(int descriptor, void* bytes, std::size_t size) {
  const ssize_t moved = transfer(kRead, kPipeRead, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_read, descriptor, bytes, moved);
}

ssize_t pread64(int descriptor, void* bytes, std::size_t size, off64_t offset) {
  const ssize_t moved = transfer(kPread, kPread, descriptor, size);
  return moved < 0 ? -1 : syscall(SYS_pread64, descriptor, bytes, moved, offset);
}

ssize_t pread(int descriptor, void* bytes, std::size_t size, off_t offset) {
  return pread64(descriptor, bytes, size, offset);
}

int fsync(int descriptor) {
  return fails(kFsync, "", descriptor) ? -1 : static_cast<int>(syscall(SYS_fsync, descriptor));
}

int fdatasync(int descriptor) {
  return fails(kFsync, "", descriptor) ? -1 : static_cast<int>(syscall(SYS_fdatasync, descriptor));
}

int rename(const char* from, const char* to) {
  return fails(kRename, to) ? -1 : static_cast<int>(syscall(SYS_rename, from, to));
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned int flags) noexcept {
  if (fails(kRename, to)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(AT_FDCWD, path, flags, mode);
}

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(AT_FDCWD, path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(folder, path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open_at(folder, path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (fails(kOpen, path)) return nullptr;
  static const auto next = behind(&fopen, "fopen64");
  return next(path, mode);
}

FILE* fopen(const char* path, const char* mode) {
  return fopen64(path, mode);
}

DIR* opendir(const char* path) {
  if (fails(kOpen, path)) return nullptr;
  static const auto next = behind(&opendir, "opendir");
  return next(path);
}

/// The descriptor is closed even if the call fails, as by Linux.
int close(int descriptor) {
  const bool failed = counts() && is_regular(descriptor) && fails(kClose, "", descriptor);
  const int error = errno;
  const int result = static_cast<int>(syscall(SYS_close, descriptor));
  if (!failed) return result;
  errno = error;
  return -1;
}

void* mmap64(void* at, std::size_t size, int access, int flags, int descriptor, off64_t offset) {
  if (fails(kMmap, "", descriptor)) return MAP_FAILED;
  return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, access, flags, descriptor, offset));
}

void* mmap(void* at, std::size_t size, int access, int flags, int descriptor, off_t offset) {
  return mmap64(at, size, access, flags, descriptor, offset);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  if (fails(kFtruncate, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}

int ftruncate(int descriptor, off_t size) noexcept {
  return ftruncate64(descriptor, size);
}

ssize_t writev(int descriptor, const iovec* pieces, int count) {
  const ssize_t moved = transfer(kWrite, kPipeWrite, descriptor, 1);
  return moved < 0 ? -1 : syscall(SYS_writev, descriptor, pieces, count);
}

int stat(const char* path, struct stat* status) noexcept {
  return fails(kStat, path) ? -1 : static_cast<int>(syscall(SYS_stat, path, status));
}

int stat64(const char* path, struct stat64* status) noexcept {
  return fails(kStat, path) ? -1 : static_cast<int>(syscall(SYS_stat, path, status));
}

int lstat(const char* path, struct stat* status) noexcept {
  return fails(kStat, path) ? -1 : static_cast<int>(syscall(SYS_lstat, path, status));
}

int lstat64(const char* path, struct stat64* status) noexcept {
  return fails(kStat, path) ? -1 : static_cast<int>(syscall(SYS_lstat, path, status));
}

int fstatat(int folder, const char* path, struct stat* status, int flags) noexcept {
  if (fails(kStat, path)) return -1;
  return static_cast<int>(syscall(SYS_newfstatat, folder, path, status, flags));
}

int fstatat64(int folder, const char* path, struct stat64* status, int flags) noexcept {
  if (fails(kStat, path)) return -1;
  return static_cast<int>(syscall(SYS_newfstatat, folder, path, status, flags));
}

int fstat(int descriptor, struct stat* status) noexcept {
  if (fails(kFstat, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_fstat, descriptor, status));
}

int fstat64(int descriptor, struct stat64* status) noexcept {
  if (fails(kFstat, "", descriptor)) return -1;
  return static_cast<int>(syscall(SYS_fstat, descriptor, status));
}

off64_t lseek64(int descriptor, off64_t offset, int from) noexcept {
  if (fails(kSeek, "", descriptor)) return -1;
  return syscall(SYS_lseek, descriptor, offset, from);
}

off_t lseek(int descriptor, off_t offset, int from) noexcept {
  return lseek64(descriptor, offset, from);
}

dirent64* readdir64(DIR* folder) {
  if (fails(kReaddir, "", dirfd(folder))) return nullptr;
  static const auto next = behind(&readdir64, "readdir64");
  return next(folder);
}

dirent* readdir(DIR* folder) {
  return reinterpret_cast<dirent*>(readdir64(folder));
}

int mkdir(const char* path, mode_t mode) noexcept {
  return fails(kMkdir, path) ? -1 : static_cast<int>(syscall(SYS_mkdir, path, mode));
}

char* mkdtemp(char* path) noexcept {
  if (fails(kMkdir, path)) return nullptr;
  static const auto next = behind(&mkdtemp, "mkdtemp");
  return next(path);
}

int unlink(const char* path) noexcept {
  return fails(kUnlink, path) ? -1 : static_cast<int>(syscall(SYS_unlink, path));
}

int rmdir(const char* path) noexcept {
  return fails(kUnlink, path) ? -1 : static_cast<int>(syscall(SYS_rmdir, path));
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  if (fails(kUnlink, path)) return -1;
  return static_cast<int>(syscall(SYS_unlinkat, folder, path, flags));
}

int remove(const char* path) noexcept {
  if (fails(kUnlink, path)) return -1;
  static const auto next = reinterpret_cast<int (*)(const char*)>(dlsym(RTLD_NEXT, "remove"));
  return next(path);
}

int link(const char* from, const char* to) noexcept {
  return fails(kLink, to) ? -1 : static_cast<int>(syscall(SYS_link, from, to));
}

int symlink(const char* from, const char* to) noexcept {
  return fails(kLink, to) ? -1 : static_cast<int>(syscall(SYS_symlink, from, to));
}

char* realpath(const char* path, char* resolved) noexcept {
  if (fails(kPath, path)) return nullptr;
  static const auto next = behind(&realpath, "realpath");
  return next(path, resolved);
}

char* getcwd(char* path, std::size_t size) noexcept {
  if (fails(kPath, "getcwd")) return nullptr;
  static const auto next = behind(&getcwd, "getcwd");
  return next(path, size);
}

ssize_t readlink(const char* path, char* target, std::size_t size) noexcept {
  return fails(kPath, path) ? -1 : syscall(SYS_readlink, path, target, size);
}

}  // extern "C"
