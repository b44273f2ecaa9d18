#pragma once

#include <string>
#include <vector>

#include "jobs/plan/plan.hpp"

namespace semigeo::jobs {

/// A file, or a job that makes one of others.
struct GraphNode {
  std::string id;     ///< of a job its name in the journal; of a file its kind and path
  std::string kind;   ///< of a job "surface", "triplets", ...; of a file "scan", "dataset", ...
  std::string name;   ///< path of a file, name of a job
  std::string state;  ///< "up to date", "would run", "unreadable", ...
  std::vector<std::string> dependencies = {};  ///< identifiers
  friend bool operator==(const GraphNode&, const GraphNode&) = default;
};

/// Every job that is planned and the file that it makes, in the order of the plan; scans, and
/// datasets that no job makes, before the jobs that read them. Dependencies come before what
/// depends on them.
std::vector<GraphNode> graph_of(const std::vector<PlannedJob>& plan);

/// {"nodes": [{"id", "kind", "name", "state", "dependencies"}]}.
std::string to_json(const std::vector<GraphNode>& graph);

/// For Graphviz: files are notes, jobs boxes, what is up to date is dashed.
std::string to_dot(const std::vector<GraphNode>& graph);

}  // namespace semigeo::jobs
