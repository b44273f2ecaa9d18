#include "jobs/plan/plan_graph.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "io/files/utf8.hpp"

namespace semigeo::jobs {
namespace {

std::string output_state(const PlannedJob& planned) {
  using Kind = Reason::Kind;
  if (!planned.error.empty()) return "unknown";
  if (planned.up_to_date || planned.sidecar_only) return "up to date";
  const Kind first = planned.reasons.front().kind;
  return first == Kind::kNoDataset || first == Kind::kNoOutput ? "missing" : "out of date";
}

std::string output_id(const Job& job) {
  return std::string(output_name_of(job.kind)) + ' ' + job.output.string();
}

bool is_job(const GraphNode& node) {
  return std::ranges::any_of(kJobKinds, [&](JobKind kind) { return node.kind == name_of(kind); });
}

/// The file that a job reads but none makes: of surface jobs the scan, of triplets jobs a dataset,
/// of recognitions the scene.
GraphNode input_of(const PlannedJob& planned) {
  const JobKind of = planned.job.kind;
  const std::string kind = of == JobKind::kSurface    ? "scan"
                           : of == JobKind::kTriplets ? "dataset"
                                                      : "scene";
  const std::string name =
      of == JobKind::kTriplets ? planned.job.input.string() : planned.scan.string();
  return {.id = kind + ' ' + name,
          .kind = kind,
          .name = name,
          .state = planned.error.empty() ? "readable" : "unreadable"};
}

GraphNode library_of(const Job& recognise) {
  const std::string kind(output_name_of(JobKind::kLibrary));
  const std::string name = recognise.library.string();
  return {.id = kind + ' ' + name, .kind = kind, .name = name, .state = "readable"};
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
  std::set<std::string> libraries;  // one node for all scenes
  for (const PlannedJob& planned : plan) {
    const Job& job = planned.job;
    GraphNode node{.id = job_id(job),
                   .kind = std::string(name_of(job.kind)),
                   .name = job.name,
                   .state = std::string(state_of(planned))};
    for (const std::size_t before : planned.after)
      node.dependencies.push_back(output_id(plan[before].job));
    const bool of_many = job.kind == JobKind::kPartition || job.kind == JobKind::kLibrary;
    if (!of_many && planned.after.empty()) {
      graph.push_back(input_of(planned));
      node.dependencies.push_back(graph.back().id);
    }
    if (job.kind == JobKind::kRecognise) {
      const GraphNode library = library_of(job);
      node.dependencies.push_back(library.id);
      if (libraries.insert(library.id).second) graph.push_back(library);
    }
    graph.push_back(node);
    graph.push_back({.id = output_id(job),
                     .kind = std::string(output_name_of(job.kind)),
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
    text += "  " + quoted(node.id) + " [shape=" + (is_job(node) ? "box" : "note") +
            ", style=" + (node.state == "up to date" ? "dashed" : "solid") +
            ", label=" + quoted((is_job(node) ? node.id : node.name) + "\n" + node.state) + "];\n";
  }
  for (const GraphNode& node : graph)
    for (const std::string& dependency : node.dependencies)
      text += "  " + quoted(dependency) + " -> " + quoted(node.id) + ";\n";
  return text + "}\n";
}

}  // namespace semigeo::jobs
