#include "jobs/archive/sources.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "io/files/container.hpp"
#include "io/files/error.hpp"
#include "io/files/read_error.hpp"
#include "io/files/small_file.hpp"
#include "jobs/archive/names.hpp"
#include "jobs/archive/path_text.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFileName = "sources.json";
constexpr io::TextBounds kBounds = {.bytes = std::int64_t{256} << 20, .depth = 1};

[[noreturn]] void refuse(const fs::path& file) {
  throw io::Error(file, "", "is damaged: it must name a scan for each dataset",
                  "remove it; datasets then count as made of the scans that are given next");
}

}  // namespace

bool is_gone(const fs::path& scan) {
  std::error_code error;
  return fs::status(io::outer_file(scan), error).type() == fs::file_type::not_found;
}

Sources Sources::read(const fs::path& archive) {
  Sources sources;
  const fs::path file = archive / kFileName;
  if (!io::is_there(file)) return sources;
  try {
    const auto document = io::read_json(file, kBounds);
    if (document.is_discarded()) refuse(file);
    for (const auto& [name, path] : document.items())
      sources.by_name_[name] = unescaped(path.get<std::string>());
  } catch (const nlohmann::json::exception&) {
    refuse(file);
  }
  return sources;
}

void Sources::claim(const std::string& name, const fs::path& scan) {
  fs::path& known = by_name_[name];
  if (known.empty() || is_gone(known)) known = scan;
}

void Sources::write(const fs::path& archive) const {
  nlohmann::json document = nlohmann::json::object();
  for (const auto& [name, scan] : by_name_) document[name] = escaped(scan.string());
  const std::string text = document.dump(2) + "\n";
  io::write_if_different(archive / kFileName, text);
}

std::vector<std::string> choose_names(
    const std::vector<Unnamed>& scans, const Sources& sources,
    const std::function<bool(const std::string&, const std::string&)>& is_of) {
  std::vector<std::size_t> order(scans.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return scans[i].scan; });

  std::vector<std::string> names(scans.size());
  std::set<std::string> taken;
  /// Gives each scan without a name the first variant of its base that `suits` it. Variants are the
  /// known names and the base itself.
  const auto pass = [&](const auto& suits) {
    for (const std::size_t i : order) {
      const Unnamed& scan = scans[i];
      const auto take = [&](const std::string& name, const fs::path* known) {
        if (!names[i].empty() || !is_variant(name, scan.base) || taken.contains(name) ||
            !suits(scan, name, known))
          return;
        names[i] = name;
        taken.insert(name);
      };
      const auto& known = sources.by_name();
      auto at = known.lower_bound(scan.base);
      if (at == known.end() || at->first != scan.base) take(scan.base, nullptr);
      for (; at != known.end() && at->first.starts_with(scan.base); ++at)
        take(at->first, &at->second);
    }
  };
  pass([](const Unnamed& scan, const std::string&, const fs::path* known) {
    return known != nullptr && *known == scan.scan;
  });
  pass([&](const Unnamed& scan, const std::string& name, const fs::path* known) {
    const bool free = name == scan.base || known == nullptr || is_gone(*known);
    return free && !scan.xxh3.empty() && is_of(name, scan.xxh3);
  });
  pass([&](const Unnamed& scan, const std::string& name, const fs::path* known) {
    return name == scan.base && (known == nullptr || is_gone(*known));
  });
  for (const std::size_t i : order)
    if (names[i].empty()) names[i] = name_with_hash(scans[i].base, scans[i].scan);
  return names;
}

}  // namespace semigeo::jobs
