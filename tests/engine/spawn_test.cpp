#include "engine/spawn.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace semigeo::engine {
namespace {

int exit_code_of(pid_t process) {
  int status = 0;
  if (waitpid(process, &status, 0) != process || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

TEST(Spawn, DescriptorsMayHaveAnyNumbers) {
  // In a process of its own, whose low descriptors can be taken away.
  const pid_t process = fork();
  if (process == 0) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) _exit(101);
    const int parent = fcntl(ends[0], F_DUPFD_CLOEXEC, 20);
    const int answers = fcntl(ends[1], F_DUPFD_CLOEXEC, 30);
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    const int high = fcntl(nothing, F_DUPFD_CLOEXEC, 40);
    for (int descriptor = 0; descriptor < 20; ++descriptor) close(descriptor);
    const std::vector<std::string> script = {
        "/bin/sh", "-c", "read a; read b <&3 || exit 102; echo out; echo \"$a$b\" >&3; exit 5"};
    const pid_t child = spawn({.arguments = script,
                               .input = answers,
                               .output = high,
                               .answers = answers,
                               .address_space_bytes = 0,
                               .cpu_seconds = 0});
    char text[4] = {};
    if (write(parent, "x\ny\n", 4) != 4 || read(parent, text, 3) != 3) _exit(103);
    _exit(std::string(text) == "xy\n" ? exit_code_of(child) : 104);
  }
  EXPECT_EQ(exit_code_of(process), 5);
}

TEST(Spawn, VariablesAreAddedToTheEnvironmentUnlessTheyAreThere) {
  const Descriptor nothing(open("/dev/null", O_RDWR | O_CLOEXEC));
  ASSERT_EQ(setenv("SEMIGEO_TEST_OURS", "kept", 1), 0);
  const std::vector<std::string> script = {
      "/bin/sh", "-c",
      "test \"$SEMIGEO_TEST_OURS\" = kept && test \"$SEMIGEO_TEST_NEW\" = 'a=b' && exit 5"};
  const pid_t child = spawn({.arguments = script,
                             .input = nothing.get(),
                             .output = nothing.get(),
                             .answers = -1,
                             .address_space_bytes = 0,
                             .cpu_seconds = 0,
                             .environment = {"SEMIGEO_TEST_OURS=lost", "SEMIGEO_TEST_NEW=a=b"}});
  EXPECT_EQ(exit_code_of(child), 5);
  unsetenv("SEMIGEO_TEST_OURS");
}

TEST(Spawn, CpuTimeCanBeLimitedLater) {
  const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
  const Descriptor owner(nothing);
  const pid_t child = spawn({.arguments = {"/bin/sh", "-c", "while :; do :; done"},
                             .input = nothing,
                             .output = nothing,
                             .answers = -1,
                             .address_space_bytes = 0,
                             .cpu_seconds = 0});
  const Descriptor end = watch(child);
  limit_cpu_time(child, 0.5);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGXCPU);
  EXPECT_NO_THROW(limit_cpu_time(child, 1));  // long gone
}

}  // namespace
}  // namespace semigeo::engine
