#include "jobs/plan/plan_graph.hpp"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "io/files/printable.hpp"
#include "jobs/plan/job_kind.hpp"

namespace semigeo::jobs {
namespace {

std::string output_state(const PlannedJob& planned) {
  using Kind = Reason::Kind;
  if (!is_readable(planned)) return "unknown";
  if (planned.up_to_date) return "up to date";
  switch (planned.reasons.front().kind) {
    case Kind::kNoDataset:
    case Kind::kNoOutput:
      return "missing";
    case Kind::kNoSidecar:
    case Kind::kDamagedSidecar:
      return "up to date";
    default:
      return "out of date";
  }
}

std::string output_id(const Job& job) {
  return job.kind->words().output + ' ' + job.output.string();
}

/// Returns the node of a file that is an input of the whole plan.
GraphNode node_of(const ExternalFile& file) {
  const std::string name = file.path.string();
  return {.id = file.kind + ' ' + name,
          .kind = file.kind,
          .name = name,
          .state = file.is_readable ? "readable" : "unreadable"};
}

/// Returns the lines in quotes, as a text of Graphviz. Names of files become printable.
std::string quoted(std::initializer_list<std::string_view> lines) {
  std::string result;
  for (const std::string_view line : lines) {
    result += result.empty() ? "\"" : "\\n";
    for (const char c : io::printable(line)) {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

std::vector<GraphNode> graph_of(const std::vector<PlannedJob>& plan) {
  std::vector<GraphNode> graph;
  std::set<std::string> files;  // a library has one node for all scenes
  for (const PlannedJob& planned : plan) {
    const Job& job = planned.job;
    GraphNode node{.id = job_id(job),
                   .kind = job.kind->words().kind,
                   .name = job.name,
                   .state = std::string(state_of(planned)),
                   .is_job = true};
    for (const std::size_t before : planned.after)
      node.dependencies.push_back(output_id(plan[before].job));
    for (const ExternalFile& file : job.kind->external_files(planned)) {
      const GraphNode input = node_of(file);
      node.dependencies.push_back(input.id);
      if (files.insert(input.id).second) graph.push_back(input);
    }
    graph.push_back(node);
    graph.push_back({.id = output_id(job),
                     .kind = job.kind->words().output,
                     .name = job.output.string(),
                     .state = output_state(planned),
                     .dependencies = {node.id}});
  }
  return graph;
}

std::string to_json(const std::vector<GraphNode>& graph) {
  auto nodes = nlohmann::ordered_json::array();
  for (const GraphNode& node : graph)
    nodes.push_back({{"id", node.id},
                     {"kind", node.kind},
                     {"name", node.name},
                     {"state", node.state},
                     {"dependencies", node.dependencies}});
  const nlohmann::ordered_json document = {{"nodes", nodes}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

std::string to_dot(const std::vector<GraphNode>& graph) {
  std::string text = "digraph semigeo {\n  rankdir=LR;\n";
  for (const GraphNode& node : graph) {
    text += "  " + quoted({node.id}) + " [shape=" + (node.is_job ? "box" : "note") +
            ", style=" + (node.state == "up to date" ? "dashed" : "solid") +
            ", label=" + quoted({node.is_job ? node.id : node.name, node.state}) + "];\n";
  }
  for (const GraphNode& node : graph)
    for (const std::string& dependency : node.dependencies)
      text += "  " + quoted({dependency}) + " -> " + quoted({node.id}) + ";\n";
  return text + "}\n";
}

}  // namespace semigeo::jobs
