#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace semigeo::io {

/// A file of arrays with names that NumPy reads by itself: a ZIP of .npy files. It appears whole or
/// not at all. The same arrays give the same bytes. Every failure of the disk is an Error that
/// names the file.
class NpzFile {
 public:
  explicit NpzFile(const std::filesystem::path& path);
  ~NpzFile();
  NpzFile(const NpzFile&) = delete;
  NpzFile& operator=(const NpzFile&) = delete;

  // Each adds an array. It has one dimension, or two if there are several `columns`, of which the
  // size must be a multiple.
  void add(const std::string& name, std::span<const float> numbers, int columns = 1);
  void add(const std::string& name, std::span<const double> numbers, int columns = 1);
  void add(const std::string& name, std::span<const std::int64_t> numbers, int columns = 1);
  /// Adds a text, UTF-8, as an array without dimensions.
  void add_text(const std::string& name, const std::string& text);
  /// Adds a number as an array without dimensions.
  void add_number(const std::string& name, double number);

  /// Gives the file its name. It must be called last.
  void commit();

 private:
  class Zip;
  template <typename Number>
  void add_numbers(const std::string& name, const char* type, std::span<const Number> numbers,
                   int columns);

  std::unique_ptr<Zip> zip_;
};

}  // namespace semigeo::io
