#include "io/files/file_signature.hpp"
#include "io/files/lower_case.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace semigeo::io {
namespace {

/// Bytes at a place of a file, and what they show. Text is compared in lower case and may stand
/// behind a byte-order mark and blanks.
struct Row {
  std::string_view bytes;
  FileSignature signature;
  bool is_text = false;
  std::size_t at = 0;
};

constexpr const char* kMeshIt = "mesh the points and export the surface as .ply";
constexpr const char* kExportIt = "export the surface as .ply";
constexpr const char* kFindScan = "give the scan in its place";
constexpr const char* kUtf8 = "save it as UTF-8 or ASCII text";

using namespace std::string_view_literals;

constexpr FileSignature kVtkXml = {"a VTK XML file", "correct its extension to .vtp", ".vtp"};
constexpr std::string_view kXml = "<?xml";

constexpr std::array kRows = {
    Row{"version https://git-lfs.github.com/spec/"sv,
        {"a pointer of Git LFS, not the content that it stands for", "fetch it with: git lfs pull",
         ""},
        true},
    Row{"<!doctype html"sv, {"a web page (HTML)", "download the scan again", ""}, true},
    Row{"<html"sv, {"a web page (HTML)", "download the scan again", ""}, true},
    Row{kXml, {"an XML document", kExportIt, ""}, true},
    Row{"PK\x03\x04"sv, {"a ZIP archive", "correct its extension to .zip", "", true}},
    Row{"PK\x05\x06"sv, {"an empty ZIP archive", "copy it again from its source", "", true}},
    Row{"7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", "correct its extension to .7z", "", true}},
    Row{"Rar!\x1a\x07"sv, {"a RAR archive", "unpack it", ""}},
    Row{"ustar"sv, {"a tar archive", "correct its extension to .tar", "", true}, false, 257},
    Row{"\xff\xfe"sv, {"UTF-16 text", kUtf8, ""}},
    Row{"\xfe\xff"sv, {"UTF-16 text", kUtf8, ""}},
    Row{"\xff\xd8\xff"sv, {"a JPEG image", kFindScan, ""}},
    Row{"\x89PNG\r\n"sv, {"a PNG image", kFindScan, ""}},
    Row{"II*\0"sv, {"a TIFF image", kFindScan, ""}},
    Row{"MM\0*"sv, {"a TIFF image", kFindScan, ""}},
    Row{"GIF8"sv, {"a GIF image", kFindScan, ""}},
    Row{"%PDF-"sv, {"a PDF document", kFindScan, ""}},
    Row{"ASTM-E57"sv, {"an E57 point cloud", kMeshIt, ""}},
    Row{"LASF"sv, {"a LAS point cloud", kMeshIt, ""}},
    Row{"glTF"sv, {"a binary glTF file", "correct its extension to .glb", ".glb"}},
    Row{"Kaydara FBX Binary"sv, {"an FBX model", kExportIt, ""}},
    Row{"\x89HDF\r\n\x1a\n"sv, {"an HDF5 file", kExportIt, ""}},
    Row{"ply\n"sv, {"a PLY file", "correct its extension to .ply", ".ply"}},
    Row{"ply\r"sv, {"a PLY file", "correct its extension to .ply", ".ply"}},
    Row{"solid "sv, {"an STL file", "correct its extension to .stl", ".stl"}},
    Row{"# vtk datafile"sv, {"a VTK file", "correct its extension to .vtk", ".vtk"}, true},
    Row{"<vtkfile"sv, kVtkXml, true},
    Row{"OFF\n"sv, {"an OFF file", "correct its extension to .off", ".off"}},
    Row{"OFF\r"sv, {"an OFF file", "correct its extension to .off", ".off"}},
};

constexpr FileSignature kZeros = {.what = "nothing but zeros",
                                  .remedy = "copy it again from its source",
                                  .extension = "",
                                  .is_zeros = true};
constexpr FileSignature kUtf16 = {.what = "UTF-16 text", .remedy = kUtf8, .extension = ""};

std::string_view text_of(std::string_view begin) {
  if (begin.starts_with("\xef\xbb\xbf")) begin.remove_prefix(3);
  begin.remove_prefix(std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
  return begin;
}

bool matches(const Row& row, std::string_view begin) {
  const std::string_view bytes = row.is_text ? text_of(begin) : begin;
  if (bytes.size() < row.at) return false;
  const std::string_view found = bytes.substr(row.at, row.bytes.size());
  return std::ranges::equal(
      found, row.bytes, [&](char a, char b) { return row.is_text ? lower_case(a) == b : a == b; });
}

/// Returns whether every second byte is zero and the others are characters of ASCII text.
bool is_utf16_without_mark(std::string_view begin) {
  constexpr std::size_t kFewest = 16;
  begin = begin.substr(0, std::min<std::size_t>(begin.size(), 256) / 2 * 2);
  if (begin.size() < kFewest) return false;
  const auto holds = [&](std::size_t first_text) {
    for (std::size_t i = 0; i < begin.size(); i += 2) {
      const char c = begin[i + first_text];
      const bool text = (c >= ' ' && c <= '~') || c == '\t' || c == '\n' || c == '\r';
      if (!text || begin[i + 1 - first_text] != 0) return false;
    }
    return true;
  };
  return holds(0) || holds(1);
}

}  // namespace

std::optional<FileSignature> file_signature(std::string_view begin) {
  if (begin.empty()) return std::nullopt;
  if (begin.find_first_not_of('\0') == std::string_view::npos) return kZeros;
  const auto* const row =
      std::ranges::find_if(kRows, [&](const Row& known) { return matches(known, begin); });
  if (row != kRows.end() && row->bytes == kXml && begin.find("<VTKFile") != begin.npos)
    return kVtkXml;
  if (row != kRows.end()) return row->signature;
  if (is_utf16_without_mark(begin)) return kUtf16;
  return std::nullopt;
}

}  // namespace semigeo::io
