#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "io/files/container.hpp"

namespace semigeo::jobs {

/// The digest of a scan and its companions (io/scans/companions.hpp), or why there is none.
struct ScanDigest {
  std::string xxh3;
  std::string error;
  std::vector<std::filesystem::path> companions = {};
  std::uintmax_t companion_bytes = 0;  ///< Size of its companions if they are members.
};

/// Returns whether a member is hidden, or is in a hidden folder.
bool is_hidden_member(const std::string& name);

/// Lists each container (io::list_container) in a child process, one for each core at a time,
/// because a damaged container may make a library crash or loop.
std::vector<io::ContainerListing> list_containers(
    const std::vector<std::filesystem::path>& containers);

/// Members of a container whose digests are wanted.
struct WantedMembers {
  std::filesystem::path container;
  std::vector<std::string> names;  ///< Names of scans in it, each once.
};

/// Returns the digest of each member, by its name. Each container is read in one pass, and in a
/// second one if members have companions, in a child process, `at_once` of them at a time (0: one
/// for each core).
std::vector<std::map<std::string, ScanDigest>> digests_of_members(
    const std::vector<WantedMembers>& wanted, int at_once);

}  // namespace semigeo::jobs
