#include "jobs/archive/containers.hpp"

#include <nlohmann/json.hpp>
#include <set>

#include "io/files/error.hpp"
#include "io/files/json_value.hpp"
#include "io/scans/companions.hpp"
#include "jobs/archive/in_children.hpp"
#include "jobs/archive/path_text.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Returns the CPU seconds that one pass over a container may take: far more than it usually does.
double most_seconds(const fs::path& container) {
  constexpr double kLeast = 600;
  constexpr double kBytesPerSecond = 1e6;
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(container, error);
  return kLeast + (error ? 0 : static_cast<double>(bytes) / kBytesPerSecond);
}

/// Returns why a child that read a container has ended without an answer.
std::string problem_of(const fs::path& container, const engine::ForkedResult& result) {
  constexpr DamageWords kWords{
      .endless = "it is damaged so that reading it never ends",
      .crash = "it is damaged so that reading it crashes",
      .remedy = "copy it again from its source, or unpack it and give the scans"};
  return unfinished_reading(result, container, kWords).what();
}

std::string text_of(const io::ContainerListing& listing) {
  json members = json::array();
  for (const io::Member& member : listing.members)
    members.push_back({escaped(member.name), member.bytes, member.encrypted});
  return json{{"members", members},
              {"links", listing.links},
              {"repeated", listing.repeated},
              {"error", escaped(listing.error)}}
      .dump();
}

io::ContainerListing listing_from(const std::string& text) {
  const json document = json::parse(text);
  io::ContainerListing listing;
  for (const json& member : document.at("members")) {
    auto& read = listing.members.emplace_back();
    read.name = unescaped(member.at(0).get<std::string>());
    io::read_value(member.at(1), read.bytes);
    io::read_value(member.at(2), read.encrypted);
  }
  io::read_value(document.at("links"), listing.links);
  io::read_value(document.at("repeated"), listing.repeated);
  listing.error = unescaped(document.at("error").get<std::string>());
  return listing;
}

/// What was read of a member.
struct MemberContent {
  io::ScanContent content = {};
  std::int64_t bytes = 0;
  std::string error = {};
};

/// Passes over a container once and reads the members of these names. Those that are not there are
/// not in the result.
std::map<std::string, MemberContent> contents_of(const fs::path& container,
                                                 std::set<std::string> names) {
  std::map<std::string, MemberContent> contents;
  try {
    io::ContainerReader reader(container);
    while (!names.empty() && reader.next()) {
      if (reader.kind() != io::ContainerReader::Kind::kFile || names.erase(reader.name()) == 0)
        continue;
      MemberContent& member = contents[reader.name()];
      try {
        member.content = io::scan_content(reader);
        member.bytes = reader.position();
      } catch (const io::Error& error) {
        member.error = error.what();
      }
    }
  } catch (const io::Error& error) {
    for (const std::string& name : names) contents[name].error = error.what();
  }
  return contents;
}

/// Returns the digests of members as JSON: name, digest, error, companions, their bytes.
std::string digest_text(const WantedMembers& wanted) {
  const auto members = contents_of(wanted.container, {wanted.names.begin(), wanted.names.end()});
  std::set<std::string> names;
  const auto name_of = [&](const fs::path& companion) {
    return companion.lexically_relative(wanted.container).native();
  };
  for (const auto& [name, member] : members)
    for (const fs::path& companion : member.content.companions) names.insert(name_of(companion));
  const auto companions = names.empty() ? std::map<std::string, MemberContent>()
                                        : contents_of(wanted.container, std::move(names));
  json digests = json::array();
  for (const std::string& name : wanted.names) {
    const auto member = members.find(name);
    if (member == members.end()) {
      const io::Error gone(wanted.container / name, "", "is gone", "run again");
      digests.push_back({escaped(name), "", escaped(gone.what()), json::array(), 0});
      continue;
    }
    std::string error = member->second.error;
    std::vector<std::string> others, paths;
    std::int64_t bytes = 0;
    for (const fs::path& companion : member->second.content.companions) {
      const auto other = companions.find(name_of(companion));
      const MemberContent found = other == companions.end() ? MemberContent() : other->second;
      others.push_back(found.content.xxh3);
      paths.push_back(companion.native());
      bytes += found.bytes;
      if (error.empty()) error = found.error;
    }
    digests.push_back({escaped(name), io::xxh3_with_companions(member->second.content.xxh3, others),
                       escaped(error), escaped_all(paths), bytes});
  }
  return digests.dump();
}

/// Returns the digest that digest_text has written.
ScanDigest digest_from(const json& member) {
  ScanDigest digest{.xxh3 = member.at(1).get<std::string>(),
                    .error = unescaped(member.at(2).get<std::string>()),
                    .companions = {},
                    .companion_bytes = 0};
  io::read_value(member.at(4), digest.companion_bytes);
  for (std::string& path : unescaped_all(member.at(3).get<std::vector<std::string>>()))
    digest.companions.emplace_back(std::move(path));
  return digest;
}

}  // namespace

bool is_hidden_member(const std::string& name) {
  return name.starts_with('.') || name.find("/.") != std::string::npos;
}

std::vector<io::ContainerListing> list_containers(const std::vector<fs::path>& containers) {
  const auto results = in_children(
      containers.size(), 0,
      [&](std::size_t i) { return text_of(io::list_container(containers[i])); },
      [&](std::size_t i) { return most_seconds(containers[i]); });
  std::vector<io::ContainerListing> listings(containers.size());
  for (std::size_t i = 0; i < listings.size(); ++i) {
    if (results[i].exit_code == 0) {
      listings[i] = listing_from(results[i].text);
    } else {
      listings[i].error = problem_of(containers[i], results[i]);
    }
  }
  return listings;
}

std::vector<std::map<std::string, ScanDigest>> digests_of_members(
    const std::vector<WantedMembers>& wanted, int at_once) {
  const auto results = in_children(
      wanted.size(), at_once, [&](std::size_t i) { return digest_text(wanted[i]); },
      [&](std::size_t i) { return most_seconds(wanted[i].container); });
  std::vector<std::map<std::string, ScanDigest>> digests(wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (results[i].exit_code == 0) {
      for (const json& member : json::parse(results[i].text))
        digests[i][unescaped(member.at(0).get<std::string>())] = digest_from(member);
      continue;
    }
    const std::string problem = problem_of(wanted[i].container, results[i]);
    for (const std::string& name : wanted[i].names)
      digests[i][name] = {.xxh3 = "", .error = problem};
  }
  return digests;
}

}  // namespace semigeo::jobs
