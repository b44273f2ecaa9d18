#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "engine/run_context.hpp"

namespace semigeo::engine {

/// Runs named tasks with dependencies once, on a set of workers. A task starts when all tasks that
/// it comes after have succeeded. When one throws, everything that depends on it, directly or not,
/// is skipped, and the rest goes on.
class TaskGraph {
 public:
  /// Names a task of the graph: its place in the order of adding.
  using Task = std::int32_t;
  /// The state of a task at the end.
  enum class State { kDone, kFailed, kSkipped };
  /// Tells how a task ended.
  struct Outcome {
    State state = State::kSkipped;
    std::exception_ptr error;  ///< What a failed task threw.
  };

  /// Adds a task that comes after the tasks `after`, which must have been added before, so that no
  /// cycle can arise. Among ready tasks the one with the highest `cost` is preferred. A task may
  /// use the workers itself.
  Task add(std::string name, const std::vector<Task>& after, std::function<void()> work,
           double cost = 1);

  /// Runs all tasks. result[t] is the outcome of task t. After a stop request no further task
  /// starts.
  std::vector<Outcome> run(const RunContext& context);

  std::int64_t size() const { return static_cast<std::int64_t>(nodes_.size()); }
  const std::string& name(Task task) const { return nodes_[task].name; }

 private:
  struct Node {
    std::string name;
    std::vector<Task> before;  ///< Tasks that come after this one.
    std::int32_t dependencies = 0;
    std::function<void()> work;
    double cost = 1;
  };
  struct Run;

  std::vector<Node> nodes_;
};

/// Rethrows the error of the first failed task, if any.
void rethrow_first(const std::vector<TaskGraph::Outcome>& outcomes);

}  // namespace semigeo::engine
