#pragma once

#include <string>
#include <vector>

#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// A node of the graph: a file, or a job that makes a file from others.
struct GraphNode {
  std::string id;     ///< Identifier of the job, or kind and path of the file.
  std::string kind;   ///< "surface", "triplets", ... for jobs; "scan", "dataset", ... for files.
  std::string name;   ///< Name of the job, or path of the file.
  std::string state;  ///< "up to date", "would run", "unreadable", ...
  std::vector<std::string> dependencies = {};  ///< Identifiers of what the node is made from.
  bool is_job = false;
  friend bool operator==(const GraphNode&, const GraphNode&) = default;
};

/// Returns every job that is planned and the file that it makes, in the order of the plan. Files
/// that no job makes stand before the first job that reads them, so that dependencies come before
/// what depends on them.
std::vector<GraphNode> graph_of(const std::vector<PlannedJob>& plan);

/// Returns the graph as JSON: {"nodes": [{"id", "kind", "name", "state", "dependencies"}]}.
std::string to_json(const std::vector<GraphNode>& graph);

/// Returns the graph in the language of Graphviz: files are notes, jobs are boxes, and what is up
/// to date has a dashed outline.
std::string to_dot(const std::vector<GraphNode>& graph);

}  // namespace semigeo::jobs
