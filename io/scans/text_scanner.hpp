#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/files/byte_source.hpp"

namespace semigeo::io {

/// Says what a text format adds to words separated by blanks.
struct TextSyntax {
  bool hash_comments = false;        ///< '#' starts a comment that ends with the line.
  bool backslash_continues = false;  ///< '\' before the end of a line joins the next one to it.
};

/// Reads words and numbers of a text, line by line. Lines may have any length and end in LF, CR LF
/// or CR, the last one in nothing. A byte-order mark of UTF-8 is skipped. Errors name the line.
class TextScanner {
 public:
  /// The largest length of a word: a longer one is an `Error`, because a word must fit the source's
  /// window.
  static constexpr std::size_t kMaxWord = 4096;

  /// Reads from where `source` stands; `source` must not be moved meanwhile except by `release`.
  /// `first_line` is the number of the line there.
  explicit TextScanner(ByteSource& source, TextSyntax syntax = {}, std::int64_t first_line = 1);

  ~TextScanner() { release(); }
  TextScanner(const TextScanner&) = delete;
  TextScanner& operator=(const TextScanner&) = delete;

  /// Returns the number of the current line, from 1.
  std::int64_t line() const { return line_; }
  /// Skips blanks. Returns whether the rest of the line holds nothing (or a comment).
  bool at_line_end() {
    if (cursor_ != end_ && *cursor_ == ' ') ++cursor_;
    if (cursor_ != end_ && *cursor_ > '#' && *cursor_ < '\\') return false;  // digits and signs
    return skip_blanks();
  }
  /// Leaves the current line. Returns false if the text ends with it.
  bool next_line();
  /// Leaves the current line, which ends at its end even if a backslash stands there: a name may be
  /// a path of Windows. Returns false if the text ends with it.
  bool next_line_after_name();
  /// Skips empty lines until something is ahead. Returns false if the text ends first.
  bool skip_to_content();
  /// Returns the next word of the line, which stays ahead; it is empty at the end of the line. It
  /// is valid until the next call.
  std::string_view peek();
  /// Takes the next word of the line; it is empty at the end of the line. It is valid until the
  /// next call.
  std::string_view word();
  /// Takes the first bytes of the next word of the line; the rest is the next word.
  void take(std::size_t bytes);
  /// Takes the next word of the line as a number. `what` names it in the error: "an x coordinate".
  double number(std::string_view what);
  /// Takes the next word of the line as a whole number.
  std::int64_t integer(std::string_view what);
  /// Throws the Error of the current line.
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) const;
  /// Moves the source to where the scanner stands.
  void release();

 private:
  bool refill(std::size_t bytes);
  /// Skips blanks. Returns whether the rest of the line holds nothing (or a comment).
  bool skip_blanks();
  /// Makes the whole next word lie in the window.
  void reach_word() {
    if (end_ - cursor_ < static_cast<std::ptrdiff_t>(kMaxWord)) refill(kMaxWord);
  }
  std::string_view word_window();
  bool skip_continuation();
  void skip_newline();
  bool is_word_end(const char* p) const;
  [[noreturn]] void fail_expecting(std::string_view what);

  ByteSource& source_;
  TextSyntax syntax_;
  const char* start_ = nullptr;  // what the source has ahead
  const char* cursor_ = nullptr;
  const char* end_ = nullptr;
  std::int64_t line_;
  bool source_ended_ = false;
  bool lone_carriage_returns_ = false;
};

}  // namespace semigeo::io
