#pragma once

#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "jobs/run/runner.hpp"

namespace semigeo::tests {

/// A runner that runs nothing. A test says what becomes of each job that is started: `on_start`
/// puts events into the queue. A job of which nobody says anything is done at once.
class FakeRunner : public jobs::Runner {
 public:
  bool orders_jobs() const override { return orders; }
  bool waits() const override { return is_waited_for; }

  void start(const std::vector<jobs::JobStart>& jobs, const jobs::Say& say) override {
    say_ = say;
    for (const jobs::JobStart& job : jobs) {
      started.push_back(job.planned->job.name);
      shares.push_back(job.share);
      if (on_start) {
        on_start(job);
      } else {
        answer(job.number, jobs::JobState::kDone);
      }
    }
    most_waiting = std::max(most_waiting, events.size());
  }

  jobs::RunnerEvent wait() override {
    if (events.empty())
      return jobs::JobLost{.number = 0, .wanted = true, .cause = {}, .error = {}, .seconds = 0};
    jobs::RunnerEvent event = std::move(events.front());
    events.pop_front();
    if (on_wait) on_wait();
    return event;
  }

  std::string stop_notice(std::size_t running) const override {
    return std::to_string(running) + " running jobs may end";
  }
  void cancel_waiting() override {
    ++waiting_cancelled;
    if (on_cancel_waiting) on_cancel_waiting();
  }
  void cancel_running() override {
    ++running_cancelled;
    if (on_cancel_running) on_cancel_running();
  }

  void answer(std::size_t job, jobs::JobState state, const std::string& error = {}) {
    jobs::JobAnswered answered{.number = job, .outcome = {}};
    answered.outcome.state = state;
    answered.outcome.error = error;
    answered.outcome.threads = 1;
    events.emplace_back(std::move(answered));
  }
  /// The output of a job could not be written.
  void refuse(std::size_t job, int code, const std::string& error) {
    answer(job, jobs::JobState::kFailed, error);
    std::get<jobs::JobAnswered>(events.back()).outcome.write_error = code;
  }
  void lose(std::size_t job, bool wanted = false) {
    events.emplace_back(jobs::JobLost{.number = job,
                                      .wanted = wanted,
                                      .cause = "crashed",
                                      .error = "its job crashed; run again",
                                      .seconds = 1});
  }
  void say(const std::string& line) const { say_(line); }

  bool orders = false;
  bool is_waited_for = true;
  std::function<void(const jobs::JobStart&)> on_start;
  std::function<void()> on_wait;
  std::function<void()> on_cancel_waiting;
  std::function<void()> on_cancel_running;
  std::deque<jobs::RunnerEvent> events;
  std::vector<std::string> started;
  std::vector<engine::Amount> shares;
  std::size_t most_waiting = 0;
  int waiting_cancelled = 0;
  int running_cancelled = 0;

 private:
  jobs::Say say_;
};

}  // namespace semigeo::tests
