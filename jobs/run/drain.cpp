#include "jobs/run/drain.hpp"

#include <signal.h>

#include <array>
#include <atomic>

namespace semigeo::jobs {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM};

// A signal handler is given nothing but its signal.
std::atomic<engine::ChildProcesses*> waiting = nullptr;
std::atomic<int> received = 0;
std::array<struct sigaction, kSignals.size()> before;

void receive(int) {
  ++received;
  if (engine::ChildProcesses* children = waiting) children->wake();
}

}  // namespace

Drain::Drain(engine::ChildProcesses& children) {
  received = 0;
  waiting = &children;
  struct sigaction action {};
  action.sa_handler = receive;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before[i]);
}

Drain::~Drain() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
  waiting = nullptr;
}

int Drain::requests() const {
  return received;
}

}  // namespace semigeo::jobs
