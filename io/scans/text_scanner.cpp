#include "io/scans/text_scanner.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "io/files/error.hpp"
#include "io/scans/decimal.hpp"

namespace semigeo::io {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool is_newline(char c) {
  return c == '\n' || c == '\r';
}

constexpr const char* kCopyAgain = "copy the file again from its source";
constexpr const char* kMendLine = "correct the line or export the scan again";

/// Returns a word for a message. It is cut to a readable length and has no control characters.
std::string quoted(std::string_view word) {
  constexpr std::size_t kShown = 40;
  std::string text = "'";
  for (const char c : word.substr(0, kShown)) text += c >= ' ' && c < 127 ? c : '?';
  return text + (word.size() > kShown ? "...'" : "'");
}

}  // namespace

TextScanner::TextScanner(ByteSource& source, TextSyntax syntax, std::int64_t first_line)
    : source_(source), syntax_(syntax), line_(first_line) {
  start_ = cursor_ = end_ = source_.ahead().data();
  refill(kMaxWord);
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (first_line == 1 && source_.ahead().substr(0, kByteOrderMark.size()) == kByteOrderMark)
    cursor_ += kByteOrderMark.size();
}

void TextScanner::release() {
  source_.consume(static_cast<std::size_t>(cursor_ - start_));
  start_ = cursor_;
}

bool TextScanner::refill(std::size_t bytes) {
  if (source_ended_) return cursor_ != end_;
  release();
  source_ended_ = !source_.fill(bytes);
  const std::string_view ahead = source_.ahead();
  start_ = cursor_ = ahead.data();
  end_ = cursor_ + ahead.size();
  return cursor_ != end_;
}

bool TextScanner::skip_continuation() {
  reach_word();
  if (end_ - cursor_ >= 2 && cursor_[1] == '\n') {
    cursor_ += 2;
  } else if (end_ - cursor_ >= 2 && cursor_[1] == '\r') {
    cursor_ += end_ - cursor_ >= 3 && cursor_[2] == '\n' ? 3 : 2;
  } else {
    return false;
  }
  ++line_;
  return true;
}

bool TextScanner::skip_blanks() {
  for (;;) {
    if (cursor_ == end_ && !refill(kMaxWord)) return true;
    const char c = *cursor_;
    if (is_blank(c)) {
      ++cursor_;
    } else if (is_newline(c) || (c == '#' && syntax_.hash_comments)) {
      return true;
    } else if (c != '\\' || !syntax_.backslash_continues || !skip_continuation()) {
      return false;
    }
  }
}

bool TextScanner::next_line() {
  bool in_comment = false;
  for (;;) {
    if (cursor_ == end_ && !refill(kMaxWord)) return false;
    const char c = *cursor_;
    if (is_newline(c)) break;
    in_comment |= c == '#' && syntax_.hash_comments;
    // A backslash at the end of a comment, as in paths of Windows, does not continue the line.
    if (c == '\\' && syntax_.backslash_continues && !in_comment && skip_continuation()) continue;
    ++cursor_;
  }
  skip_newline();
  return true;
}

bool TextScanner::next_line_after_name() {
  const TextSyntax syntax = std::exchange(syntax_, {.hash_comments = syntax_.hash_comments});
  const bool more = next_line();
  syntax_ = syntax;
  return more;
}

void TextScanner::skip_newline() {
  reach_word();
  ++line_;
  if (*cursor_++ == '\n') return;
  const bool line_feed = cursor_ < end_ && *cursor_ == '\n';
  // In a text whose lines end in CR alone, an LF after it is not part of the end of the line. It
  // may be binary data.
  if (!line_feed) lone_carriage_returns_ = true;
  if (line_feed && !lone_carriage_returns_) ++cursor_;
}

bool TextScanner::skip_to_content() {
  while (at_line_end())
    if (!next_line()) return false;
  return true;
}

bool TextScanner::is_word_end(const char* p) const {
  if (p == end_) return true;
  const char c = *p;
  if (c > '#' && c != '\\') return false;  // nearly all characters
  if (c == '\\') return syntax_.backslash_continues && end_ - p >= 2 && is_newline(p[1]);
  return is_blank(c) || is_newline(c) || (c == '#' && syntax_.hash_comments);
}

std::string_view TextScanner::peek() {
  if (at_line_end()) return {};
  reach_word();
  const char* stop = cursor_;
  while (!is_word_end(stop)) ++stop;
  const auto length = static_cast<std::size_t>(stop - cursor_);
  if (length > kMaxWord) fail("a word is longer than " + std::to_string(kMaxWord) + " characters");
  return {cursor_, length};
}

std::string_view TextScanner::word() {
  const std::string_view next = peek();
  cursor_ += next.size();
  return next;
}

void TextScanner::take(std::size_t bytes) {
  cursor_ += std::min(bytes, peek().size());
}

std::string_view TextScanner::word_window() {
  reach_word();
  return {cursor_, std::min<std::size_t>(end_ - cursor_, kMaxWord)};
}

double TextScanner::number(std::string_view what) {
  if (at_line_end()) fail_expecting(what);
  const Decimal decimal = parse_decimal(word_window());
  const char* stop = decimal.end;
  if (stop != cursor_ && !std::isfinite(decimal.value))  // "1.#QNAN"
    while (!is_word_end(stop)) ++stop;
  if (stop == cursor_ || !is_word_end(stop)) fail_expecting(what);
  cursor_ = stop;
  return decimal.value;
}

std::int64_t TextScanner::integer(std::string_view what) {
  if (at_line_end()) fail_expecting(what);
  const std::string_view text = word_window();
  const char* first = text.data();
  if (*first == '+' && text.size() > 1 && text[1] != '-') ++first;
  std::int64_t value = 0;
  const auto [stop, status] = std::from_chars(first, text.data() + text.size(), value);
  if (status != std::errc{} || !is_word_end(stop)) fail_expecting(what);
  cursor_ = stop;
  return value;
}

void TextScanner::fail(const std::string& problem, const std::string& remedy) const {
  throw Error(source_.path(), "line " + std::to_string(line_), problem, remedy);
}

void TextScanner::fail_expecting(std::string_view what) {
  const std::string expected(what);
  if (!at_line_end()) fail("expected " + expected + ", found " + quoted(peek()), kMendLine);
  if (cursor_ == end_) fail("the file ends where " + expected + " should be", kCopyAgain);
  fail("the line ends where " + expected + " should be", kMendLine);
}

}  // namespace semigeo::io
