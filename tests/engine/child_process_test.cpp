#include "engine/child_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <system_error>

#include "engine/descriptor.hpp"
#include "engine/spawn.hpp"
#include "tests/engine/children.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::engine {
namespace {

namespace fs = std::filesystem;
using Ended = ChildProcesses::Ended;
using Id = ChildProcesses::Id;
using Limit = ChildProcesses::Limit;
using Line = ChildProcesses::Line;
using TimedOut = ChildProcesses::TimedOut;

std::string contents(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Ended run(const Command& command) {
  ChildProcesses children;
  children.start(command);
  return next<Ended>(children);
}

/// What a script prints.
std::string output_of(const std::string& script, ProcessLimits limits = {}) {
  const tests::TemporaryFolder folder;
  Command command = shell(script);
  command.log = folder / "log";
  command.limits = limits;
  EXPECT_EQ(run(command).exit_code, 0) << contents(command.log);
  return contents(command.log);
}

/// Waits until a process, not necessarily a child, has ended.
bool ends(pid_t process) {
  try {
    const Descriptor watched = watch(process);
    pollfd end = {watched.get(), POLLIN, 0};
    return poll(&end, 1, static_cast<int>(1000 * kLong)) == 1;
  } catch (const std::system_error& e) {
    return e.code() == std::errc::no_such_process;
  }
}

std::ptrdiff_t open_descriptors() {
  return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
}

/// A shell loop that ends when the process has used so many hundredths of a CPU second.
const std::string kBurn =
    "burn() { until read _ _ _ _ _ _ _ _ _ _ _ _ _ user system _ < /proc/self/stat;"
    " [ $((user + system)) -ge $1 ]; do :; done; }; ";

TEST(ChildProcess, TellsTheExitCode) {
  for (const int code : {0, 1, 75, 255}) {
    const Ended ended = run(shell("exit " + std::to_string(code)));
    EXPECT_EQ(ended.exit_code, code);
    EXPECT_EQ(ended.signal, 0);
    EXPECT_EQ(ended.limit, Limit::kNone);
  }
}

TEST(ChildProcess, TellsTheSignal) {
  for (const int signal : {SIGSEGV, SIGTERM, SIGKILL}) {
    const Ended ended = run(shell("kill -" + std::to_string(signal) + " $$"));
    EXPECT_EQ(ended.exit_code, -1);
    EXPECT_EQ(ended.signal, signal);
    EXPECT_EQ(ended.limit, Limit::kNone);
  }
}

TEST(ChildProcess, TellsWhatWasUsed) {
  const Ended ended = run(shell(kBurn + "burn 20"));
  EXPECT_GE(ended.cpu_seconds, 0.19);  // two counters, each rounded
  EXPECT_GE(ended.wall_seconds, ended.cpu_seconds - 0.05);
  EXPECT_LT(ended.wall_seconds, kLong);
  EXPECT_GE(ended.peak_resident_bytes, 100'000u);
}

TEST(ChildProcess, PassesArgumentsUnchanged) {
  const tests::TemporaryFolder folder;
  Command command;
  command.arguments = {"/usr/bin/printf", "[%s]", "a b", "", "$HOME", "\"*\"\n"};
  command.log = folder / "log";
  EXPECT_EQ(run(command).exit_code, 0);
  EXPECT_EQ(contents(command.log), "[a b][][$HOME][\"*\"\n]");
}

TEST(ChildProcess, WallTimeIsLimited) {
  Command command = shell("while :; do sleep 1000; done");
  command.limits.wall_seconds = 0.1;
  const Ended ended = run(command);
  EXPECT_EQ(ended.limit, Limit::kWallTime);
  EXPECT_EQ(ended.signal, SIGKILL);
  EXPECT_GE(ended.wall_seconds, 0.1);
}

TEST(ChildProcess, CpuTimeIsLimited) {
  Command command = shell("while :; do :; done");
  command.limits.cpu_seconds = 0.5;  // rounded up
  const Ended ended = run(command);
  EXPECT_EQ(ended.limit, Limit::kCpuTime);
  EXPECT_EQ(ended.signal, SIGXCPU);
  // The limit counts ticks of the clock, of which a busy machine gives a process more than it has
  // used; but never more than there have been.
  EXPECT_GE(ended.wall_seconds, 0.9);
  EXPECT_GT(ended.cpu_seconds, 0);
  EXPECT_LT(ended.cpu_seconds, 2);
}

TEST(ChildProcess, AddressSpaceIsLimited) {
  const tests::TemporaryFolder folder;
  Command command = shell("exec dd bs=200M count=1 if=/dev/zero of=/dev/null");
  command.log = folder / "log";
  command.limits.address_space_bytes = 64 << 20;
  const Ended ended = run(command);
  EXPECT_GT(ended.exit_code, 0);
  EXPECT_EQ(ended.limit, Limit::kNone);
  EXPECT_NE(contents(command.log), "");
  command.limits.address_space_bytes = 0;
  EXPECT_EQ(run(command).exit_code, 0);
  command.limits.address_space_bytes = 64 << 20;
  EXPECT_EQ(output_of("ulimit -v; ulimit -H -v", command.limits), "65536\n65536\n");
}

TEST(ChildProcess, ALimitEndsItsChildOnly) {
  ChildProcesses children;
  Command stuck = conversing("read forever");
  stuck.limits.wall_seconds = 0.05;
  const Id good = children.start(conversing("read line; exit 3"));
  const Id bad = children.start(stuck);
  const Ended first = next<Ended>(children);
  EXPECT_EQ(first.child, bad);
  EXPECT_EQ(first.limit, Limit::kWallTime);
  children.send(good, "go on");
  const Ended second = next<Ended>(children);
  EXPECT_EQ(second.child, good);
  EXPECT_EQ(second.exit_code, 3);
}

/// The CPU time of a process in ticks, which is what its limit counts.
double ticks_of(pid_t process) {
  timespec time = {};
  clock_gettime(static_cast<clockid_t>(~static_cast<unsigned>(process) << 3), &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST(ChildProcess, ClocksOfAPersistentChildStartAgain) {
  ChildProcesses children;
  Command command = conversing(
      "echo $$ >&3; while read times; do i=0; while [ $i -lt $times ]; do i=$((i + 1)); done;"
      " ulimit -S -t >&3; done; while :; do :; done");
  command.limits.cpu_seconds = 1000;
  command.limits.wall_seconds = kLong;
  const Id child = children.start(command);
  const pid_t process = std::stoi(next<Line>(children).text);
  do {
    children.send(child, "100000");
    EXPECT_EQ(next<Line>(children).text, "1000");
  } while (ticks_of(process) == 0);
  children.restart_clocks(child, 1000, kLong);
  children.send(child, "1");
  EXPECT_GE(std::stoi(next<Line>(children).text), 1001);  // what it has used is not counted
  children.restart_clocks(child, 0.1, kLong);
  children.close_input(child);  // and it loops for ever
  EXPECT_EQ(next<Ended>(children).limit, Limit::kCpuTime);
}

TEST(ChildProcess, DeadlineOfAPersistentChildIsReplaced) {
  ChildProcesses children;
  Command command = conversing("while read line; do echo $line >&3; done");
  command.limits.wall_seconds = 0.2;
  const Id child = children.start(command);
  children.restart_clocks(child, 0, 0);  // none
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0.4)));
  children.send(child, "alive");
  EXPECT_EQ(next<Line>(children).text, "alive");
  children.restart_clocks(child, 0, 0.05);
  EXPECT_EQ(next<Ended>(children).limit, Limit::kWallTime);
}

TEST(ChildProcess, OutputGoesToTheLog) {
  const tests::TemporaryFolder folder;
  Command command = shell("echo out; echo err >&2");
  command.log = folder / "logs/of/a/job.log";
  run(command);
  EXPECT_EQ(contents(command.log), "out\nerr\n");
  command.append_to_log = true;
  run(command);
  EXPECT_EQ(contents(command.log), "out\nerr\nout\nerr\n");
  command.append_to_log = false;
  run(command);
  EXPECT_EQ(contents(command.log), "out\nerr\n");
}

TEST(ChildProcess, ALogThatCannotBeMadeIsNamed) {
  const tests::TemporaryFolder folder;
  Command command = shell("");
  command.log = folder.path();
  ChildProcesses children;
  try {
    children.start(command);
    FAIL() << "started";
  } catch (const std::system_error& e) {
    EXPECT_EQ(e.code(), std::errc::is_a_directory);
    EXPECT_NE(std::string(e.what()).find(command.log.string()), std::string::npos) << e.what();
  }
  EXPECT_EQ(children.running(), 0u);
}

TEST(ChildProcess, LinesGoBackAndForthWithSeveralAtOnce) {
  ChildProcesses children;
  constexpr int kChildren = 8;
  constexpr int kLines = 50;
  std::map<Id, int> answered;
  for (int c = 0; c < kChildren; ++c) {
    const Id child =
        children.start(conversing("while read n; do echo $((n + 1)) >&3; done; exit 7"));
    answered[child] = 0;
    children.send(child, "0");
  }
  for (int ended = 0; ended < kChildren;) {
    const auto event = children.wait(kLong);
    if (const auto* line = std::get_if<Line>(&event)) {
      ASSERT_EQ(line->text, std::to_string(++answered.at(line->child)));
      if (answered[line->child] < kLines) {
        children.send(line->child, line->text);
      } else {
        children.close_input(line->child);
      }
    } else {
      ASSERT_TRUE(std::holds_alternative<Ended>(event));
      EXPECT_EQ(std::get<Ended>(event).exit_code, 7);
      ++ended;
    }
  }
  for (const auto& [child, lines] : answered) EXPECT_EQ(lines, kLines);
}

TEST(ChildProcess, LinesComeBeforeTheEndAndTornOnesDoNot) {
  ChildProcesses children;
  children.start(conversing("printf 'one\\n\\nthree\\ntorn' >&3"));
  EXPECT_EQ(next<Line>(children).text, "one");
  EXPECT_EQ(next<Line>(children).text, "");
  EXPECT_EQ(next<Line>(children).text, "three");
  EXPECT_EQ(next<Ended>(children).exit_code, 0);
}

TEST(ChildProcess, AllThatAnEndedChildHasSentArrives) {
  ChildProcesses children;
  // More than one read takes, less than the socket holds.
  const Id child = children.start(conversing("echo $$ >&3; read go; exec seq 1 14000 >&3"));
  const pid_t process = std::stoi(next<Line>(children).text);
  children.send(child, "go");
  ASSERT_TRUE(ends(process));
  for (int n = 1; n <= 14'000; ++n) ASSERT_EQ(next<Line>(children).text, std::to_string(n));
  EXPECT_EQ(next<Ended>(children).exit_code, 0);
}

TEST(ChildProcess, LongLinesPassWholeWhoeverReadsLate) {
  ChildProcesses children;
  const std::string line(900'000, 'x');  // more than a socket holds
  const Id child = children.start(conversing("read go; head -n 1 >&3"));
  children.send(child, "go");
  children.send(child, line);
  children.send(child, line);  // left unread
  children.close_input(child);
  EXPECT_EQ(next<Line>(children).text, line);
  EXPECT_EQ(next<Ended>(children).exit_code, 0);
  children.send(child, "to nobody");
  children.kill(child);
  children.restart_clocks(child, 1, 1);
  EXPECT_TRUE(std::holds_alternative<TimedOut>(children.wait(0)));
}

TEST(ChildProcess, AnEndlessLineEndsTheChild) {
  ChildProcesses children;
  children.start(conversing("exec cat /dev/zero >&3"));
  const Ended ended = next<Ended>(children);
  EXPECT_EQ(ended.limit, Limit::kLineLength);
  EXPECT_EQ(ended.signal, SIGKILL);
}

TEST(ChildProcess, InputOfOthersIsEmpty) {
  EXPECT_EQ(output_of("cat"), "");
}

TEST(ChildProcess, GetsNoDescriptorsButItsOwn) {
  const Descriptor leak(open("/dev/null", O_RDONLY));  // without O_CLOEXEC
  ASSERT_TRUE(leak);
  EXPECT_EQ(output_of("exec ls /proc/self/fd"), "0\n1\n2\n3\n");  // 3 is the folder that ls reads
  const tests::TemporaryFolder folder;
  Command command = conversing("exec ls /proc/self/fd");
  command.log = folder / "log";
  run(command);
  EXPECT_EQ(contents(command.log), "0\n1\n2\n3\n4\n");
}

TEST(ChildProcess, StartsWhereStandardDescriptorsAreClosed) {
  const pid_t process = fork();
  if (process == 0) {
    for (const int descriptor : {0, 1, 2, 3}) close(descriptor);
    ChildProcesses children;
    const Id child = children.start(conversing("read line; echo \"<$line>\" >&3; exit 9"));
    children.send(child, "text");
    _exit(next<Line>(children).text == "<text>" ? next<Ended>(children).exit_code : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(process, &status, 0), process);
  EXPECT_EQ(WEXITSTATUS(status), 9);
}

TEST(ChildProcess, StartsWithDefaultSignals) {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = signal(SIGINT, SIG_IGN);
  const std::string signals = output_of("exec sed -n '/^Sig[BIC]/p' /proc/self/status");
  signal(SIGINT, handler);
  sigset_t after;
  pthread_sigmask(SIG_SETMASK, &before, &after);
  const std::string none = "\t0000000000000000\n";
  EXPECT_EQ(signals, "SigBlk:" + none + "SigIgn:" + none + "SigCgt:" + none);
  EXPECT_EQ(sigismember(&after, SIGUSR1), 1);  // ours is as it was
  EXPECT_EQ(sigismember(&after, SIGUSR2), 0);
}

TEST(ChildProcess, LeadsAGroup) {
  EXPECT_EQ(output_of("read pid name state parent group rest < /proc/self/stat;"
                      " [ $pid = $group ] && echo yes"),
            "yes\n");
}

TEST(ChildProcess, DumpsNoCore) {
  rlimit before = {};
  getrlimit(RLIMIT_CORE, &before);
  if (before.rlim_max == 0) GTEST_SKIP() << "nothing here dumps a core";
  const rlimit whole = {before.rlim_max, before.rlim_max};
  setrlimit(RLIMIT_CORE, &whole);
  EXPECT_EQ(output_of("ulimit -c"), "0\n");
  setrlimit(RLIMIT_CORE, &before);
}

TEST(ChildProcess, TerminateIsAskingForIt) {
  ChildProcesses children;
  const Id child = children.start(
      conversing("trap 'echo asked >&3; exit 4' TERM; echo ready >&3; while :; do read x; done"));
  EXPECT_EQ(next<Line>(children).text, "ready");
  children.terminate(child);
  EXPECT_EQ(next<Line>(children).text, "asked");
  EXPECT_EQ(next<Ended>(children).exit_code, 4);
}

TEST(ChildProcess, WhatAChildStartsDiesWithIt) {
  ChildProcesses children;
  const Id killed = children.start(conversing("sleep 1000 & echo $! >&3; wait"));
  const pid_t sleeping = std::stoi(next<Line>(children).text);
  children.kill(killed);
  const Ended ended = next<Ended>(children);
  EXPECT_EQ(ended.signal, SIGKILL);
  EXPECT_EQ(ended.limit, Limit::kNone);
  EXPECT_TRUE(ends(sleeping));

  children.start(conversing("sleep 1000 & echo $! >&3"));
  const pid_t left_behind = std::stoi(next<Line>(children).text);
  EXPECT_EQ(next<Ended>(children).exit_code, 0);
  EXPECT_TRUE(ends(left_behind));
}

TEST(ChildProcess, ChildrenDieWithTheirOwner) {
  std::optional<ChildProcesses> children(std::in_place);
  children->start(conversing("echo $$ >&3; exec sleep 1000"));
  const pid_t child = std::stoi(next<Line>(*children).text);
  children.reset();
  EXPECT_EQ(::kill(child, 0), -1);  // not even a zombie is left
}

TEST(ChildProcess, ChildrenDieWithAKilledParent) {
  int ends_of_pipe[2];
  ASSERT_EQ(pipe2(ends_of_pipe, O_CLOEXEC), 0);
  const Descriptor from(ends_of_pipe[0]), to(ends_of_pipe[1]);
  const pid_t parent = fork();
  if (parent == 0) {
    ChildProcesses children;
    children.start(conversing("echo $$ >&3; exec sleep 1000"));
    const pid_t child = std::stoi(next<Line>(children).text);
    if (write(to.get(), &child, sizeof child) != sizeof child) _exit(1);
    children.wait();
    _exit(1);
  }
  pid_t child = 0;
  ASSERT_EQ(read(from.get(), &child, sizeof child), static_cast<ssize_t>(sizeof child));
  EXPECT_EQ(::kill(child, 0), 0);
  ASSERT_EQ(::kill(parent, SIGKILL), 0);
  EXPECT_TRUE(ends(child));
  waitpid(parent, nullptr, 0);
}

TEST(ChildProcess, AProgramThatCannotRunIsNamed) {
  const tests::TemporaryFolder folder;
  const fs::path text = folder / "text";
  std::ofstream(text) << "no program";
  ChildProcesses children;
  const auto error_of = [&](const fs::path& path) {
    Command command;
    command.arguments = {path.string()};
    try {
      children.start(command);
    } catch (const std::system_error& e) {
      EXPECT_NE(std::string(e.what()).find(path.string()), std::string::npos) << e.what();
      return e.code();
    }
    return std::error_code();
  };
  EXPECT_EQ(error_of(folder / "missing"), std::errc::no_such_file_or_directory);
  EXPECT_EQ(error_of(text), std::errc::permission_denied);
  fs::permissions(text, fs::perms::owner_all);
  EXPECT_EQ(error_of(text), std::errc::executable_format_error);
  EXPECT_EQ(children.running(), 0u);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_THROW(children.start({}), std::invalid_argument);
}

TEST(ChildProcess, ManyLeaveNothingBehind) {
  const std::ptrdiff_t before = open_descriptors();
  {
    ChildProcesses children;
    const std::ptrdiff_t idle = open_descriptors();
    for (int n = 0; n < 200; ++n) {
      children.start(conversing("exit 0"));
      ASSERT_EQ(next<Ended>(children).exit_code, 0);
      ASSERT_EQ(children.running(), 0u);
    }
    EXPECT_EQ(open_descriptors(), idle);
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
  EXPECT_EQ(open_descriptors(), before);
}

}  // namespace
}  // namespace semigeo::engine
