#pragma once

#include <functional>
#include <string>
#include <string_view>
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

/// Calls visit(node) for every job that is planned and for the file that it makes, in the order of
/// the plan. Files that no job makes stand before the first job that reads them, so that
/// dependencies come before what depends on them. No more than a node is in memory at a time,
/// besides the names of files.
void for_each_node(const std::vector<PlannedJob>& plan,
                   const std::function<void(const GraphNode&)>& visit);

/// Takes a document piece by piece.
using WriteText = std::function<void(std::string_view)>;

/// Writes the graph as JSON: {"nodes": [{"id", "kind", "name", "state", "dependencies"}]}.
void write_graph_json(const std::vector<PlannedJob>& plan, const WriteText& write);

/// Writes the graph in the language of Graphviz: files are notes, jobs are boxes, and what is up to
/// date has a dashed outline.
void write_graph_dot(const std::vector<PlannedJob>& plan, const WriteText& write);

}  // namespace semigeo::jobs
