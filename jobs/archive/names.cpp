#include "jobs/archive/names.hpp"

#include <cctype>
#include <string_view>
#include <utility>

#include "io/files/file_digest.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHashDigits = 8;
constexpr std::size_t kMaxNameLength = 180;
constexpr std::string_view kMark = "--";  // a base never has this in the same place

std::string short_hash(const std::string& text) {
  return io::xxh3_of_text(text).substr(0, kHashDigits);
}

bool is_safe(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
}

/// Returns whether "__" in the name could come from anything but the joining of folders.
bool has_misleading_underscore(const std::string& path) {
  return path.find("__") != std::string::npos || path.find("_/") != std::string::npos ||
         path.find("/_") != std::string::npos;
}

}  // namespace

std::string dataset_name(const fs::path& relative) {
  const std::string path = relative.generic_string();
  std::string name;
  bool exact = !has_misleading_underscore(path);
  for (const char c : path) {
    if (c == '/') {
      name += "__";
    } else if (is_safe(c)) {
      name += c;
    } else {
      name += '_';
      exact = false;
    }
  }
  if (name.size() > kMaxNameLength) {
    name = name.substr(name.size() - kMaxNameLength);
    exact = false;
  }
  if (name.starts_with('.')) {  // a hidden dataset would be passed over
    name.front() = '_';
    exact = false;
  }
  return exact ? name : name + "-" + short_hash(path);
}

std::string name_with_hash(const std::string& base, const fs::path& scan) {
  return base + std::string(kMark) + short_hash(scan.string());
}

bool is_variant(const std::string& name, const std::string& base) {
  return name == base || (name.size() == base.size() + kMark.size() + kHashDigits &&
                          name.starts_with(base + std::string(kMark)));
}

std::string given_name(const fs::path& scan, const std::string& name) {
  const std::string path = scan.generic_string();
  const auto with_name = [&](std::string text) {
    return std::move(text.append(" (").append(name).append(")"));
  };
  for (std::size_t at = path.size(); at > 0;) {
    at = path.rfind('/', at - 1);
    at = at == std::string::npos ? 0 : at;
    std::string below = path.substr(at == 0 && !path.starts_with('/') ? 0 : at + 1);
    const std::string base = dataset_name(below);
    if (name == base) return below;
    if (is_variant(name, base)) return with_name(std::move(below));
  }
  return path.empty() ? name : with_name(scan.filename().string());
}

}  // namespace semigeo::jobs
