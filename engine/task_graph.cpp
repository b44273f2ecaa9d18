#include "engine/task_graph.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

namespace semigeo::engine {

/// Holds the state of one run. Counters only fall. The thread that brings the counter of a task to
/// zero starts the task.
struct TaskGraph::Run {
  Run(std::vector<Node>& graph_nodes, const RunContext& run_context)
      : nodes(graph_nodes),
        context(run_context),
        waiting_for(std::make_unique<std::atomic<std::int32_t>[]>(graph_nodes.size())),
        blocked(std::make_unique<std::atomic<bool>[]>(graph_nodes.size())),
        outcomes(graph_nodes.size()) {
    for (std::size_t t = 0; t < nodes.size(); ++t) waiting_for[t] = nodes[t].dependencies;
  }

  void start_all(Workers::Group& group, std::vector<Task> ready) {
    // The group prefers the task that it got last.
    std::stable_sort(ready.begin(), ready.end(),
                     [&](Task a, Task b) { return nodes[a].cost < nodes[b].cost; });
    for (const Task t : ready) group.run([this, &group, t] { execute(group, t); });
  }

  void execute(Workers::Group& group, Task task) {
    Node& node = nodes[task];
    Outcome& outcome = outcomes[task];
    if (!blocked[task] && !context.stop.stop_requested()) {
      std::string message;
      try {
        node.work();
        outcome.state = State::kDone;
      } catch (const std::exception& e) {
        outcome = {State::kFailed, std::current_exception()};
        message = e.what();
      } catch (...) {
        outcome = {State::kFailed, std::current_exception()};
        message = "unknown exception";
      }
      context.observer.task_ended(node.name, message);
    }
    node.work = nullptr;  // frees what it holds

    std::vector<Task> ready;
    for (const Task t : node.before) {
      if (outcome.state != State::kDone) blocked[t] = true;
      if (waiting_for[t].fetch_sub(1) == 1) ready.push_back(t);
    }
    start_all(group, std::move(ready));
  }

  std::vector<Node>& nodes;
  const RunContext& context;
  std::unique_ptr<std::atomic<std::int32_t>[]> waiting_for;
  std::unique_ptr<std::atomic<bool>[]> blocked;
  std::vector<Outcome> outcomes;
};

TaskGraph::Task TaskGraph::add(std::string name, const std::vector<Task>& after,
                               std::function<void()> work, double cost) {
  const auto task = static_cast<Task>(nodes_.size());
  for (const Task t : after) nodes_[t].before.push_back(task);
  nodes_.push_back(
      {std::move(name), {}, static_cast<std::int32_t>(after.size()), std::move(work), cost});
  return task;
}

std::vector<TaskGraph::Outcome> TaskGraph::run(const RunContext& context) {
  Run run(nodes_, context);
  context.workers.run_group([&](Workers::Group& group) {
    std::vector<Task> ready;
    for (std::size_t t = 0; t < nodes_.size(); ++t)
      if (nodes_[t].dependencies == 0) ready.push_back(static_cast<Task>(t));
    run.start_all(group, std::move(ready));
  });
  return std::move(run.outcomes);
}

void rethrow_first(const std::vector<TaskGraph::Outcome>& outcomes) {
  for (const auto& outcome : outcomes)
    if (outcome.error) std::rethrow_exception(outcome.error);
}

}  // namespace semigeo::engine
