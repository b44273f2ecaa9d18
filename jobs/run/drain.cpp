#include "jobs/run/drain.hpp"

#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>

namespace semigeo::jobs {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM};

// A signal handler is given nothing but its signal.
std::atomic<engine::ChildProcesses*> waiting = nullptr;
std::atomic<void (*)()> end_at_once = nullptr;
std::atomic<pid_t> owner = 0;
std::atomic<int> received = 0;
bool counts_already = false;

using Actions = std::array<struct sigaction, kSignals.size()>;
Actions before_early;
Actions before_drain;

void receive(int) {
  ++received;
  if (getpid() != owner) _exit(EXIT_FAILURE);  // a child that was forked meanwhile
  if (void (*end)() = end_at_once) end();
  if (engine::ChildProcesses* children = waiting) children->wake();
}

void install(Actions& before) {
  owner = getpid();
  struct sigaction action {};
  action.sa_handler = receive;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before[i]);
}

void restore(const Actions& before) {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
}

}  // namespace

EarlySignals::EarlySignals() {
  received = 0;
  counts_already = true;
  install(before_early);
}

EarlySignals::~EarlySignals() {
  restore(before_early);
  counts_already = false;
}

EndAtOnce::EndAtOnce(void (*end)()) {
  end_at_once = end;
  if (received > 0) end();
}

EndAtOnce::~EndAtOnce() {
  end_at_once = nullptr;
}

Drain::Drain(engine::ChildProcesses& children) {
  if (!counts_already) received = 0;
  waiting = &children;
  install(before_drain);
  if (received > 0) children.wake();
}

Drain::~Drain() {
  restore(before_drain);
  waiting = nullptr;
}

int Drain::requests() const {
  return received;
}

}  // namespace semigeo::jobs
