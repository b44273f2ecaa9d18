#include "jobs/plan/plan_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"

namespace semigeo::jobs {
namespace {

/// Jobs in every state.
std::vector<PlannedJob> plan() {
  std::vector<PlannedJob> jobs;
  const auto add = [&](const std::string& name) -> PlannedJob& {
    PlannedJob planned;
    planned.scan = "/in/" + name;
    planned.job.kind = &surface_kind();
    planned.job.data = SurfaceJobData{};
    planned.job.name = name;
    planned.job.output = "archive/scans/" + name + ".vtkhdf";
    jobs.push_back(planned);
    return jobs.back();
  };
  add("a.ply").up_to_date = true;
  add("b.ply").reasons = {{.kind = Reason::Kind::kNoDataset}};
  add("c.ply").reasons = {{.kind = Reason::Kind::kScan}};
  PlannedJob& sidecar = add("d.ply");
  sidecar.reasons = {{.kind = Reason::Kind::kNoSidecar}};
  surface_data(sidecar.job).sidecar_only = true;
  add("e.ply").error = "cannot be read";
  return jobs;
}

std::vector<GraphNode> graph_of(const std::vector<PlannedJob>& plan) {
  std::vector<GraphNode> graph;
  for_each_node(plan, [&](const GraphNode& node) { graph.push_back(node); });
  return graph;
}

std::string dot_of(const std::vector<PlannedJob>& plan) {
  std::string text;
  write_graph_dot(plan, [&](std::string_view piece) { text += piece; });
  return text;
}

std::string json_of(const std::vector<PlannedJob>& plan) {
  std::string text;
  write_graph_json(plan, [&](std::string_view piece) { text += piece; });
  return text;
}

TEST(PlanGraphTest, LeadsFromScansThroughJobsToDatasets) {
  const auto graph = graph_of(plan());
  ASSERT_EQ(graph.size(), 15u);
  EXPECT_EQ(graph[3],
            (GraphNode{
                .id = "scan /in/b.ply", .kind = "scan", .name = "/in/b.ply", .state = "readable"}));
  EXPECT_EQ(graph[4], (GraphNode{.id = "surface b.ply",
                                 .kind = "surface",
                                 .name = "b.ply",
                                 .state = "would run",
                                 .dependencies = {"scan /in/b.ply"},
                                 .is_job = true}));
  EXPECT_EQ(graph[5], (GraphNode{.id = "dataset archive/scans/b.ply.vtkhdf",
                                 .kind = "dataset",
                                 .name = "archive/scans/b.ply.vtkhdf",
                                 .state = "missing",
                                 .dependencies = {"surface b.ply"}}));
  std::vector<std::string> states;
  for (const GraphNode& node : graph) states.push_back(node.state);
  EXPECT_EQ(states, (std::vector<std::string>{"readable", "up to date", "up to date", "readable",
                                              "would run", "missing", "readable", "would run",
                                              "out of date", "readable", "would run", "up to date",
                                              "unreadable", "unreadable", "unknown"}));
  std::set<std::string> known;
  for (const GraphNode& node : graph) {
    for (const std::string& dependency : node.dependencies)
      EXPECT_TRUE(known.contains(dependency)) << dependency;
    EXPECT_TRUE(known.insert(node.id).second) << node.id;
  }
}

TEST(PlanGraphTest, LeadsFromDatasetsToALibrary) {
  std::vector<PlannedJob> jobs = plan();
  jobs.erase(jobs.begin() + 1, jobs.end());
  const auto add = [&](const JobKind& kind, const char* name, std::vector<std::size_t> after) {
    PlannedJob planned;
    planned.job = {.kind = &kind, .name = name, .input = "b.vtkhdf", .output = name, .key = {}};
    planned.after = std::move(after);
    planned.reasons = {{.kind = Reason::Kind::kNoOutput}};
    jobs.push_back(planned);
  };
  add(triplets_kind(), "a", {0});
  add(triplets_kind(), "b", {});
  add(partition_kind(), "p", {1, 2});
  add(library_kind(), "l", {3});
  const auto graph = graph_of(jobs);
  const auto dependencies = [&](const std::string& id) {
    return std::ranges::find(graph, id, &GraphNode::id)->dependencies;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(dependencies("triplets a"), (Names{"dataset archive/scans/a.ply.vtkhdf"}));
  EXPECT_EQ(dependencies("triplets b"), (Names{"dataset b.vtkhdf"}));
  EXPECT_EQ(dependencies("partition p"), (Names{"run a", "run b"}));
  EXPECT_EQ(dependencies("library l"), (Names{"postings p"}));
  EXPECT_EQ(dependencies("hash library l"), (Names{"library l"}));
  EXPECT_EQ(graph.back().state, "missing");
  EXPECT_NE(dot_of(jobs).find("\"library l\" [shape=box, style=solid"), std::string::npos);
  EXPECT_NE(dot_of(jobs).find("\"run a\" [shape=note"), std::string::npos);
}

TEST(PlanGraphTest, ScenesShareTheirLibrary) {
  std::vector<PlannedJob> jobs(2);
  for (PlannedJob& planned : jobs) {
    const std::string name = &planned == jobs.data() ? "a" : "b";
    planned.job = {.kind = &recognise_kind(),
                   .name = name,
                   .input = name + ".ply",
                   .output = name + ".json",
                   .key = {},
                   .data = RecogniseJobData{.library = "/l.h5"}};
    planned.scan = "/in/" + name + ".ply";
    planned.reasons = {{.kind = Reason::Kind::kNoOutput}};
  }
  std::vector<std::string> ids;
  const auto graph = graph_of(jobs);
  for (const GraphNode& node : graph) ids.push_back(node.id);
  EXPECT_EQ(ids, (std::vector<std::string>{"scene /in/a.ply", "hash library /l.h5", "recognise a",
                                           "recognition a.json", "scene /in/b.ply", "recognise b",
                                           "recognition b.json"}));
  for (const std::size_t job : {2, 5})
    EXPECT_EQ(graph[job].dependencies.back(), "hash library /l.h5");
}

TEST(PlanGraphTest, JsonHoldsEveryNode) {
  const std::string text = json_of(plan());
  const auto document = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(text, document.dump(2) + '\n');  // as if it were written at once
  ASSERT_EQ(document["nodes"].size(), graph_of(plan()).size());
  EXPECT_EQ(document["nodes"][4]["id"], "surface b.ply");
  EXPECT_EQ(document["nodes"][4]["dependencies"][0], "scan /in/b.ply");
  EXPECT_EQ(json_of({}), "{\n  \"nodes\": []\n}\n");
}

TEST(PlanGraphTest, DotQuotesWhatNamesMayHold) {
  auto jobs = plan();
  jobs.resize(1);
  jobs[0].scan = "/in/a \"b\"\\\n\xff.ply";
  const std::string dot = dot_of(jobs);
  EXPECT_EQ(dot,
            "digraph semigeo {\n"
            "  rankdir=LR;\n"
            "  \"scan /in/a \\\"b\\\"\\\\\\\\n\\\\xff.ply\" [shape=note, style=solid, "
            "label=\"/in/a \\\"b\\\"\\\\\\\\n\\\\xff.ply\\nreadable\"];\n"
            "  \"surface a.ply\" [shape=box, style=dashed, "
            "label=\"surface a.ply\\nup to date\"];\n"
            "  \"dataset archive/scans/a.ply.vtkhdf\" [shape=note, style=dashed, "
            "label=\"archive/scans/a.ply.vtkhdf\\nup to date\"];\n"
            "  \"scan /in/a \\\"b\\\"\\\\\\\\n\\\\xff.ply\" -> \"surface a.ply\";\n"
            "  \"surface a.ply\" -> \"dataset archive/scans/a.ply.vtkhdf\";\n"
            "}\n");
}

}  // namespace
}  // namespace semigeo::jobs
