#include "jobs/cli/similar_report.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "jobs/cli/failures.hpp"
#include "jobs/cli/json_output.hpp"
#include "jobs/cli/output.hpp"
#include "jobs/cli/recognise_report.hpp"
#include "jobs/cli/run_report.hpp"
#include "jobs/kinds/given_names.hpp"
#include "jobs/run/progress.hpp"
#include "jobs/stages/recognised_file.hpp"

namespace semigeo::jobs::cli {
namespace {

using nlohmann::json;

/// A surface lies on another one if this share of it does. The rest is noise and holes.
constexpr double kAll = 0.9;
/// The least resemblance as a whole of things of one kind.
constexpr double kAlike = 0.85;

/// A model and how it resembles a scan.
struct Resembling {
  std::string model;        ///< Name of the model.
  double whole = 0;         ///< Resemblance as a whole.
  json candidate = {};      ///< What recognition says; empty if it has no pose of the model.
  bool one_object = false;  ///< Recognition says that both are of one object.

  double part() const { return candidate.is_null() ? 0 : candidate.at("score").get<double>(); }
  double share(const char* name) const {
    return candidate.is_null() ? 0 : candidate.at(name).get<double>();
  }
  /// Says in a word or two how the model is related to the scan. `it` is the word for the scan.
  std::string relation(const std::string& it = " it") const {
    if (!one_object) return whole >= kAlike ? "alike" : "-";
    const bool model_on_scan = share("match") >= kAll;
    const bool scan_on_model = share("explained") >= kAll;
    if (model_on_scan && scan_on_model) return it.empty() ? "same as" : "same";
    if (model_on_scan) return "part of" + it;
    return scan_on_model ? "contains" + it : "overlaps";
  }
};

/// A scan, and all models that were found to resemble it, the most alike first.
struct Query {
  std::string input;       ///< Path of the scan.
  std::string model = {};  ///< The model that the scan is itself; empty if it is none.
  std::vector<Resembling> models = {};
};

Query query_of(const PlannedJob& planned) {
  const json document = read_recognised(planned.job.output);
  const double min_score = document.at("search").at("min_score").get<double>();
  std::map<std::string, json> candidates;
  for (const json& candidate : document.at("ranking"))
    candidates.emplace(candidate.at("model").get<std::string>(), candidate);
  Query query = {.input = planned.job.input.string()};
  const std::string own = document.at("scene").value("dataset_digest", "");
  for (const json& entry : document.at("resemblance")) {
    Resembling model = {.model = entry.at("model").get<std::string>(),
                        .whole = entry.at("whole").get<double>()};
    if (!own.empty() && entry.at("model_digest") == own) {
      query.model = model.model;
      continue;
    }
    if (const auto found = candidates.find(model.model); found != candidates.end())
      model.candidate = found->second;
    model.one_object = model.part() > 0 && model.part() >= min_score;
    query.models.push_back(std::move(model));
  }
  std::ranges::stable_sort(query.models, [](const Resembling& a, const Resembling& b) {
    const auto rank = [](const Resembling& m) {
      return std::tuple(!m.one_object, m.one_object ? -m.part() : 0, -m.whole);
    };
    return rank(a) < rank(b);
  });
  return query;
}

std::vector<Query> queries_of(const RunResult& result) {
  std::vector<Query> queries;
  for (std::size_t i = 0; i < result.plan.size(); ++i)
    if (is_made(result.outcomes[i].state)) queries.push_back(query_of(result.plan[i]));
  return queries;
}

/// Says that two scans are of one object.
struct Link {
  std::size_t scan;   ///< Index of the member that was searched for.
  std::size_t model;  ///< Index of the member in which it was found.
  const Resembling* resembling;
};

/// Scans and models, joined to groups of one object.
class Groups {
 public:
  Groups(const std::vector<Query>& queries, const GivenNames& given) {
    for (const Query& query : queries) {
      const std::size_t scan = query.model.empty() ? member("scan " + query.input, query.input)
                                                   : member_of(query.model, given);
      for (const Resembling& model : query.models) {
        if (!model.one_object) continue;
        const std::size_t other = member_of(model.model, given);
        add({scan, other, &model});
        group_[group_of(scan)] = group_of(other);
      }
    }
  }

  const std::string& name(std::size_t member) const { return names_[member]; }

  /// Returns the members of each group that has more than one, and the links in it.
  std::vector<std::pair<std::vector<std::size_t>, std::vector<Link>>> all() {
    std::map<std::size_t, std::pair<std::vector<std::size_t>, std::vector<Link>>> groups;
    for (std::size_t i = 0; i < names_.size(); ++i) groups[group_of(i)].first.push_back(i);
    for (const Link& link : links_) groups[group_of(link.scan)].second.push_back(link);
    std::vector<std::pair<std::vector<std::size_t>, std::vector<Link>>> result;
    for (auto& [root, group] : groups)
      if (group.first.size() > 1) result.push_back(std::move(group));
    std::ranges::stable_sort(result, std::ranges::greater(),
                             [](const auto& group) { return group.first.size(); });
    return result;
  }

 private:
  /// Adds a link, of two between the same members the stronger one.
  void add(const Link& link) {
    const auto same = std::ranges::find_if(links_, [&](const Link& other) {
      return other.scan == link.model && other.model == link.scan;
    });
    if (same == links_.end())
      links_.push_back(link);
    else if (link.resembling->part() > same->resembling->part())
      *same = link;
  }
  std::size_t member_of(const std::string& model, const GivenNames& given) {
    return member("model " + model, given.shown(model));
  }
  std::size_t member(const std::string& key, const std::string& name) {
    const auto [place, is_new] = index_.emplace(key, names_.size());
    if (is_new) {
      names_.push_back(name);
      group_.push_back(place->second);
    }
    return place->second;
  }
  std::size_t group_of(std::size_t member) {
    while (group_[member] != member) member = group_[member] = group_[group_[member]];
    return member;
  }

  std::map<std::string, std::size_t> index_;
  std::vector<std::string> names_;
  std::vector<std::size_t> group_;
  std::vector<Link> links_;
};

void print_lists(const std::vector<Query>& queries, std::size_t top, const GivenNames& given) {
  for (const Query& query : queries) {
    print(query.input, "\n");
    if (query.models.empty()) print("  the library has no other model\n");
    std::vector<std::vector<std::string>> rows = {
        {"model", "whole", "part", "match", "explained", "relation"}};
    for (const Resembling& model : query.models) {
      if (rows.size() > top) break;
      const auto number = [&](double value, int digits) {
        return model.candidate.is_null() ? std::string("-") : io::fixed_text(value, digits);
      };
      rows.push_back({io::printable(given.shown(model.model)), io::fixed_text(model.whole, 3),
                      number(model.part(), 4), number(model.share("match"), 3),
                      number(model.share("explained"), 3), model.relation()});
    }
    if (rows.size() > 1) print_text(table_text(rows, 2, "lrrrrl"));
    print("\n");
  }
}

void print_groups(const std::vector<Query>& queries, const GivenNames& given) {
  Groups groups(queries, given);
  const auto all = groups.all();
  std::size_t number = 0;
  for (const auto& [members, links] : all) {
    print("group ", ++number, ": ", members.size(), " of one object\n");
    for (const std::size_t member : members) print("  ", groups.name(member), "\n");
    std::vector<std::vector<std::string>> rows;
    for (const Link& link : links)
      rows.push_back({io::printable(groups.name(link.model)), link.resembling->relation(""),
                      io::printable(groups.name(link.scan)),
                      io::fixed_text(link.resembling->part(), 4)});
    print_text(table_text(rows, 4, "lllr"));
    print("\n");
  }
  if (all.empty()) print("no two of these are of one object\n\n");
}

json resembling_json(const Resembling& model, const GivenNames& given) {
  json object = {{"model", model.model}, {"whole", model.whole}, {"relation", model.relation()}};
  if (const auto scan = given.scan_of(model.model); !scan.empty()) object["scan"] = scan.string();
  if (!model.candidate.is_null()) {
    object["part"] = model.part();
    for (const char* name : {"match", "explained", "pose"}) object[name] = model.candidate.at(name);
  }
  return object;
}

json groups_json(const std::vector<Query>& queries, const GivenNames& given) {
  Groups groups(queries, given);
  json list = json::array();
  for (const auto& [members, links] : groups.all()) {
    json group = {{"members", json::array()}, {"links", json::array()}};
    for (const std::size_t member : members) group["members"].push_back(groups.name(member));
    for (const Link& link : links)
      group["links"].push_back({{"scan", groups.name(link.scan)},
                                {"model", groups.name(link.model)},
                                {"relation", link.resembling->relation()},
                                {"whole", link.resembling->whole},
                                {"part", link.resembling->part()}});
    list.push_back(std::move(group));
  }
  return list;
}

}  // namespace

void print_similar(const RunResult& result, const Searched& searched, const SimilarReport& report) {
  const GivenNames given(searched.library.path);
  const std::vector<Query> queries = queries_of(result);
  if (report.groups)
    print_groups(queries, given);
  else
    print_lists(queries, report.top, given);
  print_failures(failures_of(result), report.failures_were_told);
  print_stop(result, report.failures_were_told);
  print_passed_over(searched.passed_over);
  const RunSummary& summary = result.summary;
  print(counted(result.plan.size(), "scan"), ", ", counted(searched.library.models, "model"), ": ",
        queries.size(), " compared, ", summary.failed, " failed",
        summary.not_run > 0 ? ", " + std::to_string(summary.not_run) + " not run" : std::string(),
        "; ", short_duration(summary.wall_seconds), " wall, ", short_duration(summary.cpu_seconds),
        " CPU\n");
}

void print_similar_json(const RunResult& result, const Searched& searched,
                        const SimilarReport& report) {
  const GivenNames given(searched.library.path);
  json document = search_json(result, searched.library);
  document["scans"] = json::array();
  std::vector<Query> queries;
  for (std::size_t i = 0; i < result.plan.size(); ++i) {
    const JobOutcome& outcome = result.outcomes[i];
    json scan = {{"input", result.plan[i].job.input.string()}, {"state", name_of(outcome.state)}};
    if (!outcome.error.empty()) scan["error"] = outcome.error;
    if (is_made(outcome.state)) {
      const Query& query = queries.emplace_back(query_of(result.plan[i]));
      if (!query.model.empty()) scan["is_model"] = query.model;
      scan["similar"] = json::array();
      for (std::size_t k = 0; k < std::min(report.top, query.models.size()); ++k)
        scan["similar"].push_back(resembling_json(query.models[k], given));
    }
    document["scans"].push_back(std::move(scan));
  }
  if (report.groups) document["groups"] = groups_json(queries, given);
  add_passed_over(document, searched.passed_over);
  if (!result.stopped.empty()) document["stopped"] = result.stopped;
  print_document(document);
}

}  // namespace semigeo::jobs::cli
