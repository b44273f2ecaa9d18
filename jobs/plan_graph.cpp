#include "jobs/plan_graph.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/utf8.hpp"

namespace semigeo::jobs {
namespace {

std::string dataset_state(const PlannedJob& planned) {
  if (!planned.error.empty()) return "unknown";
  if (planned.up_to_date || planned.sidecar_only) return "up to date";
  const bool missing = planned.reasons.front().kind == Reason::Kind::kNoDataset;
  return missing ? "missing" : "out of date";
}

/// Between quotes; names may hold anything.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : io::as_utf8(text)) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

std::vector<GraphNode> graph_of(const std::vector<PlannedJob>& plan) {
  std::vector<GraphNode> graph;
  for (const PlannedJob& planned : plan) {
    const std::string scan = planned.scan.string();
    const std::string dataset = planned.job.output.string();
    graph.push_back({.id = "scan " + scan,
                     .kind = "scan",
                     .name = scan,
                     .state = planned.error.empty() ? "readable" : "unreadable"});
    graph.push_back({.id = job_id(planned.job),
                     .kind = "surface",
                     .name = planned.job.name,
                     .state = std::string(state_of(planned)),
                     .dependencies = {"scan " + scan}});
    graph.push_back({.id = "dataset " + dataset,
                     .kind = "dataset",
                     .name = dataset,
                     .state = dataset_state(planned),
                     .dependencies = {job_id(planned.job)}});
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
    const bool is_job = node.kind == "surface";
    text += "  " + quoted(node.id) + " [shape=" + (is_job ? "box" : "note") +
            ", style=" + (node.state == "up to date" ? "dashed" : "solid") +
            ", label=" + quoted((is_job ? node.id : node.name) + "\n" + node.state) + "];\n";
  }
  for (const GraphNode& node : graph)
    for (const std::string& dependency : node.dependencies)
      text += "  " + quoted(dependency) + " -> " + quoted(node.id) + ";\n";
  return text + "}\n";
}

}  // namespace semigeo::jobs
