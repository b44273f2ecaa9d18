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

void for_each_node(const std::vector<PlannedJob>& plan,
                   const std::function<void(const GraphNode&)>& visit) {
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
      if (files.insert(input.id).second) visit(input);
    }
    visit(node);
    visit({.id = output_id(job),
           .kind = job.kind->words().output,
           .name = job.output.string(),
           .state = output_state(planned),
           .dependencies = {node.id}});
  }
}

void write_graph_json(const std::vector<PlannedJob>& plan, const WriteText& write) {
  constexpr std::string_view kIndent = "    ";
  std::string_view before = "\n";
  write("{\n  \"nodes\": [");
  for_each_node(plan, [&](const GraphNode& node) {
    const nlohmann::ordered_json object = {{"id", node.id},
                                           {"kind", node.kind},
                                           {"name", node.name},
                                           {"state", node.state},
                                           {"dependencies", node.dependencies}};
    std::string text(before);
    text += kIndent;
    for (const char c : object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace)) {
      text += c;
      if (c == '\n') text += kIndent;  // names hold none: JSON writes them as escapes
    }
    write(io::printable_json(text));
    before = ",\n";
  });
  write(before == "\n" ? "]\n}\n" : "\n  ]\n}\n");
}

void write_graph_dot(const std::vector<PlannedJob>& plan, const WriteText& write) {
  write("digraph semigeo {\n  rankdir=LR;\n");
  for_each_node(plan, [&](const GraphNode& node) {
    write("  " + quoted({node.id}) + " [shape=" + (node.is_job ? "box" : "note") +
          ", style=" + (node.state == "up to date" ? "dashed" : "solid") +
          ", label=" + quoted({node.is_job ? node.id : node.name, node.state}) + "];\n");
  });
  for_each_node(plan, [&](const GraphNode& node) {
    for (const std::string& dependency : node.dependencies)
      write("  " + quoted({dependency}) + " -> " + quoted({node.id}) + ";\n");
  });
  write("}\n");
}

}  // namespace semigeo::jobs
