#include "jobs/cli/container_info.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/scans/scan_reader.hpp"
#include "jobs/archive/containers.hpp"
#include "jobs/archive/path_text.hpp"
#include "jobs/cli/command.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"

namespace semigeo::jobs::cli {
namespace {

std::string kind_of(const io::Member& member) {
  if (is_hidden_member(member.name)) return "hidden";
  if (member.encrypted) return "encrypted";
  return io::is_scan_name(member.name) ? "scan" : "no scan";
}

nlohmann::json json_of(const std::filesystem::path& container,
                       const io::ContainerListing& listing) {
  nlohmann::json members = nlohmann::json::array();
  for (const io::Member& member : listing.members)
    members.push_back(
        {{"name", escaped(member.name)}, {"bytes", member.bytes}, {"kind", kind_of(member)}});
  nlohmann::json document = {{"container", escaped(container.string())},
                             {"members", std::move(members)},
                             {"links", listing.links},
                             {"repeated", listing.repeated}};
  if (!listing.error.empty()) document["error"] = listing.error;
  return document;
}

void print_members(const io::ContainerListing& listing) {
  std::vector<std::vector<std::string>> rows = {{"bytes", "", "member"}};
  for (const io::Member& member : listing.members)
    rows.push_back({std::to_string(member.bytes), kind_of(member), io::printable(member.name)});
  print_text(table_text(rows, 0, "rll"));
  if (listing.links > 0) print(listing.links, " links are not followed\n");
  if (listing.repeated > 0)
    print(listing.repeated, " members have the name of one before them and are not read\n");
}

}  // namespace

int print_container(const std::filesystem::path& container, bool json) {
  const io::ContainerListing listing = list_containers({container}).front();
  if (json) {
    print_document(json_of(container, listing));
  } else {
    print_members(listing);
  }
  if (listing.error.empty()) return kAllDone;
  if (!json) complain(listing.error);
  return kSomeFailed;
}

}  // namespace semigeo::jobs::cli
