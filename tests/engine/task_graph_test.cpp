#include "engine/task_graph.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <stdexcept>

namespace semigeo::engine {
namespace {

using State = TaskGraph::State;

class TaskGraphTest : public testing::TestWithParam<int> {
 protected:
  Workers workers_{GetParam()};
  Observer observer_;
  std::stop_source stop_;
  RunContext context_{workers_, observer_, stop_.get_token()};
};

TEST_P(TaskGraphTest, EveryTaskComesAfterItsDependencies) {
  // A ladder as a scan's levels have it: pass k after pass k - 1, write k after pass k and write k
  // - 1.
  TaskGraph graph;
  std::vector<std::atomic<bool>> passed(50);
  std::vector<std::atomic<bool>> written(50);
  std::vector<TaskGraph::Task> pass, write;
  std::atomic<int> violations = 0;
  for (int k = 0; k < 50; ++k) {
    std::vector<TaskGraph::Task> before;
    if (k > 0) before.push_back(pass[k - 1]);
    pass.push_back(graph.add("pass", before, [&, k] {
      if (k > 0 && !passed[k - 1]) ++violations;
      passed[k] = true;
    }));
    before = {pass[k]};
    if (k > 0) before.push_back(write[k - 1]);
    write.push_back(graph.add("write", before, [&, k] {
      if (!passed[k] || (k > 0 && !written[k - 1])) ++violations;
      written[k] = true;
    }));
  }
  for (const auto& outcome : graph.run(context_)) EXPECT_EQ(outcome.state, State::kDone);
  EXPECT_EQ(violations, 0);
  EXPECT_TRUE(written[49]);
}

TEST_P(TaskGraphTest, AFailureSkipsWhatDependsOnItAndNothingElse) {
  TaskGraph graph;
  bool other_ran = false;
  const auto bad = graph.add("bad", {}, [] { throw std::runtime_error("broken"); });
  const auto child = graph.add("child", {bad}, [] { FAIL(); });
  const auto grandchild = graph.add("grandchild", {child}, [] { FAIL(); });
  const auto other = graph.add("other", {}, [&] { other_ran = true; });
  const auto outcomes = graph.run(context_);
  EXPECT_EQ(outcomes[bad].state, State::kFailed);
  EXPECT_EQ(outcomes[child].state, State::kSkipped);
  EXPECT_EQ(outcomes[grandchild].state, State::kSkipped);
  EXPECT_EQ(outcomes[other].state, State::kDone);
  EXPECT_TRUE(other_ran);
  EXPECT_THROW(rethrow_first(outcomes), std::runtime_error);
}

TEST_P(TaskGraphTest, AStopRequestStartsNothingNew) {
  TaskGraph graph;
  const auto first = graph.add("first", {}, [&] { stop_.request_stop(); });
  const auto second = graph.add("second", {first}, [] { FAIL(); });
  const auto outcomes = graph.run(context_);
  EXPECT_EQ(outcomes[first].state, State::kDone);
  EXPECT_EQ(outcomes[second].state, State::kSkipped);
}

TEST_P(TaskGraphTest, TheObserverHearsOfEveryTaskThatRan) {
  struct Recorder : Observer {
    std::mutex mutex;
    std::vector<std::pair<std::string, std::string>> heard;
    void task_ended(std::string_view task, std::string_view error) override {
      const std::scoped_lock lock(mutex);
      heard.emplace_back(task, error);
    }
  } recorder;
  TaskGraph graph;
  const auto good = graph.add("good", {}, [] {});
  const auto bad = graph.add("bad", {good}, [] { throw std::runtime_error("broken"); });
  graph.add("never", {bad}, [] {});
  graph.run({workers_, recorder, {}});
  const std::vector<std::pair<std::string, std::string>> expected = {{"good", ""},
                                                                     {"bad", "broken"}};
  EXPECT_EQ(recorder.heard, expected);
}

TEST_P(TaskGraphTest, TasksMayUseAllWorkers) {
  TaskGraph graph;
  std::atomic<int> blocks = 0;
  for (int k = 0; k < 4; ++k)
    graph.add("wide", {}, [&] { workers_.for_blocks(100, 1, [&](IndexRange) { ++blocks; }); });
  graph.run(context_);
  EXPECT_EQ(blocks, 400);
}

INSTANTIATE_TEST_SUITE_P(Threads, TaskGraphTest, testing::Values(1, 2, 4));

}  // namespace
}  // namespace semigeo::engine
