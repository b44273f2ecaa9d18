#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace semigeo::io {

/// The exception of io. Its text is one sentence that names the file, the place in it, what was
/// wrong and what to do.
class Error : public std::runtime_error {
 public:
  /// `place` is a line, a byte or a dataset ("line 12", "byte 4096", "/levels/000/points"); it may
  /// be empty. `remedy` is what the reader of the message can do; it may be empty. A problem may
  /// quote the file: what is not printable in it becomes escapes (`printable`), so that a zero byte
  /// or the end of a line does not cut the sentence.
  Error(std::filesystem::path file, std::string place, std::string problem,
        std::string remedy = {});

  const std::filesystem::path& file() const { return file_; }
  const std::string& place() const { return place_; }
  const std::string& problem() const { return problem_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::filesystem::path file_;
  std::string place_;
  std::string problem_;
  std::string remedy_;
};

}  // namespace semigeo::io
