#include "io/files/line_reader.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "io/files/error.hpp"

namespace semigeo::io {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;

}  // namespace

LineReader::LineReader(std::filesystem::path path, std::size_t longest)
    : file_(std::move(path)), longest_(longest), buffer_(kBuffer) {}

bool LineReader::fill() {
  begin_ = 0;
  end_ = file_.read(std::span(buffer_));
  return end_ > 0;
}

bool LineReader::next(std::string& line) {
  line.clear();
  bool any = false;
  while (begin_ < end_ || fill()) {
    any = true;
    const char* const first = buffer_.data() + begin_;
    const char* const last = buffer_.data() + end_;
    const char* const stop = std::find(first, last, '\n');
    if (static_cast<std::size_t>(stop - first) > longest_ - line.size())
      throw Error(file_.path(), "line " + std::to_string(number_ + 1),
                  "has more than " + std::to_string(longest_) + " bytes");
    line.append(first, stop);
    begin_ = static_cast<std::size_t>(stop - buffer_.data());
    if (stop == last) continue;
    ++begin_;
    break;
  }
  number_ += any;
  return any;
}

}  // namespace semigeo::io
