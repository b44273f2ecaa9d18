#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/error.hpp"
#include "io/scans/scan_reader.hpp"
#include "tests/support/temporary_folder.hpp"

/// What the tests of the scan readers share: bytes of binary files, gzip, and the error of a file.
namespace semigeo::io {

/// Writes a file of these bytes and returns its path.
inline std::filesystem::path write_file(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  return path;
}

/// The number's bytes in the given order.
template <typename Number>
std::string bytes_of(Number value, std::endian order = std::endian::little) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// One gzip member.
inline std::string gzip(std::string_view plain) {
  z_stream stream{};
  if (deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("deflateInit2");
  std::string packed(deflateBound(&stream, static_cast<uLong>(plain.size())) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("deflate");
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// Files of one format, read back.
class ScanFileTest : public ::testing::Test {
 protected:
  Scan read(std::string_view name, std::string_view bytes, const ScanOptions& options = {}) {
    return read_scan(write_file(folder_ / name, bytes), options);
  }

  /// The message for a file that must be refused, without the folder's name.
  std::string error(std::string_view name, std::string_view bytes,
                    const ScanOptions& options = {}) {
    try {
      read(name, bytes, options);
    } catch (const Error& failure) {
      const std::string message = failure.what();
      const std::string prefix = folder_.path().string() + "/";
      EXPECT_EQ(message.substr(0, prefix.size()), prefix);
      EXPECT_FALSE(failure.problem().empty());
      EXPECT_EQ(message.find('\n'), std::string::npos);
      return message.substr(prefix.size());
    }
    ADD_FAILURE() << "not refused:\n" << bytes.substr(0, 500);
    return {};
  }

  tests::TemporaryFolder folder_;
};

/// Expects a message to contain each of the parts.
inline void expect_parts(const std::string& message,
                         std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
}

using Triangles = std::vector<std::array<std::int32_t, 3>>;

inline Eigen::Vector3d point(const Scan& scan, std::size_t index) {
  return scan.mesh.points.at(index);
}

}  // namespace semigeo::io
