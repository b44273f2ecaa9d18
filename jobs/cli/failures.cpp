#include "jobs/cli/failures.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

constexpr std::size_t kColumns = 79;  // some terminals wrap when the last column is written
constexpr std::size_t kMostGroups = 3;
constexpr std::size_t kLinesOfGroup = 2;
constexpr std::string_view kBetween = ": ";
constexpr std::string_view kBeforeRemedy = "; ";

/// Returns whether the part of a sentence names a place in a file: "line 4", "/levels/000/points".
bool is_place(std::string_view part) {
  return part.starts_with("line ") || part.starts_with("byte ") || part.starts_with('/') ||
         part.starts_with("face ") || part.starts_with("level ");
}

/// Returns what failures of the same reason have in common: the problem, without digits.
std::string reason_of(const Failure& failure) {
  std::string_view rest = failure.sentence;
  const bool known = !failure.file.empty() && rest.starts_with(failure.file);
  const std::size_t file = known ? failure.file.size() : rest.find(kBetween);
  if (file < rest.size()) rest.remove_prefix(std::min(file + kBetween.size(), rest.size()));
  const std::size_t place = rest.find(kBetween);
  if (place != std::string_view::npos && is_place(rest.substr(0, place)))
    rest.remove_prefix(place + kBetween.size());
  std::string reason;
  for (const char c : rest.substr(0, rest.find(kBeforeRemedy))) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit) reason += c;
    if (digit && !reason.ends_with('#')) reason += '#';
  }
  return reason;
}

}  // namespace

std::vector<FailureGroup> grouped(const std::vector<Failure>& failures) {
  std::vector<FailureGroup> groups;
  std::map<std::string, std::size_t> places;
  for (const Failure& failure : failures) {
    const auto [at, is_new] = places.try_emplace(reason_of(failure), groups.size());
    if (is_new) groups.push_back({.example = failure.sentence});
    ++groups[at->second].count;
  }
  std::ranges::stable_sort(groups, std::ranges::greater(), &FailureGroup::count);
  return groups;
}

bool print_failures(const std::vector<Failure>& failures, bool told) {
  if (failures.size() <= kFew) {
    if (!told)
      for (const Failure& failure : failures) print("failed: ", failure.sentence, "\n");
    return false;
  }
  std::size_t others = failures.size();
  std::size_t shown = 0;
  const std::vector<FailureGroup> groups = grouped(failures);
  for (const FailureGroup& group : groups) {
    if (shown == kMostGroups) break;
    if (told && group.count == 1) continue;
    const std::string head =
        group.count == 1 ? "failed: " : "failed, " + std::to_string(group.count) + " times: ";
    print_text(cut(head + io::printable(group.example), kLinesOfGroup) + "\n");
    others -= group.count;
    ++shown;
  }
  const std::size_t reasons = groups.size() - shown;
  if (others > 0)
    print("failed: ", others, " more, for ",
          reasons == 1 ? "another reason" : std::to_string(reasons) + " other reasons", "\n");
  return true;
}

bool outputs_are_one_place() {
  struct stat out {};
  struct stat error {};
  return fstat(STDOUT_FILENO, &out) == 0 && fstat(STDERR_FILENO, &error) == 0 &&
         out.st_dev == error.st_dev && out.st_ino == error.st_ino;
}

std::string cut(std::string_view text, std::size_t lines) {
  constexpr std::string_view kDots = "...";
  const std::size_t most = lines * kColumns;
  if (io::count_characters(text) <= most) return std::string(text);
  return std::string(io::first_characters(text, most - kDots.size())) + std::string(kDots);
}

}  // namespace semigeo::jobs::cli
