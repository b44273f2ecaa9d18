#include "jobs/archive/archive_lock.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

/// A process that does something and tells its parent a byte at a time.
class Child {
 public:
  using Say = std::function<void(char)>;
  explicit Child(const std::function<void(const Say&)>& work) {
    std::array<int, 2> ends;
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ == 0) {
      close(ends[0]);
      work([&](char c) {
        if (write(ends[1], &c, 1) != 1) _exit(1);
      });
      _exit(0);
    }
    close(ends[1]);
    said_ = ends[0];
  }
  ~Child() {
    kill();
    close(said_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t id() const { return process_; }
  /// Waits for the next byte; '\0' if the child has ended without one.
  char heard() {
    char c = '\0';
    return read(said_, &c, 1) == 1 ? c : '\0';
  }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

 private:
  pid_t process_ = 0;
  int said_ = -1;
};

class ArchiveLockTest : public testing::Test {
 protected:
  fs::path file() const { return folder_ / "lock"; }
  nlohmann::json content() const {
    std::ifstream stream(file());
    return nlohmann::json::parse(stream);
  }
  /// A lock as another would have left it.
  void leave(const ProcessIdentity& owner) {
    std::ofstream(file()) << nlohmann::json{{"host", owner.host},
                                            {"pid", owner.pid},
                                            {"boot_id", owner.boot_id},
                                            {"process_started", owner.started},
                                            {"since", "2024-05-31T21:00:00Z"}};
  }
  /// Why the archive cannot be had; empty if it can.
  std::string refusal() {
    try {
      const ArchiveLock lock(folder_.path());
      return "";
    } catch (const LockedError& error) {
      EXPECT_EQ(error.file(), file());
      EXPECT_FALSE(error.remedy().empty());
      return error.what();
    }
  }
  /// Names in the archive besides the lock.
  std::vector<fs::path> others() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      if (entry.path() != file()) found.push_back(entry.path());
    return found;
  }

  tests::TemporaryFolder folder_;
};

TEST_F(ArchiveLockTest, ExistsAsLongAsItsOwnerHasIt) {
  {
    const ArchiveLock lock(folder_.path());
    const auto text = content();
    EXPECT_EQ(text["pid"], getpid());
    EXPECT_EQ(text["host"], this_process().host);
    EXPECT_EQ(text["boot_id"], this_process().boot_id);
    EXPECT_EQ(text["process_started"], this_process().started);
    EXPECT_EQ(text["since"].get<std::string>().size(), 20u);
    EXPECT_TRUE(others().empty());
  }
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_EQ(refusal(), "");
}

TEST_F(ArchiveLockTest, ASecondOneIsToldWhoHasIt) {
  const ArchiveLock lock(folder_.path());
  const std::string said = refusal();
  EXPECT_NE(said.find("process " + std::to_string(getpid()) + " on " + this_process().host),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("since " + content()["since"].get<std::string>()), std::string::npos) << said;
  EXPECT_NE(said.find("wait until it ends"), std::string::npos) << said;
  EXPECT_EQ(content()["pid"], getpid());
  EXPECT_TRUE(others().empty());
}

TEST_F(ArchiveLockTest, AKilledOwnersIsTakenOver) {
  Child owner([&](const Child::Say& say) {
    const ArchiveLock lock(folder_.path());
    say('k');
    for (;;) pause();
  });
  ASSERT_EQ(owner.heard(), 'k');
  EXPECT_NE(refusal().find("process " + std::to_string(owner.id())), std::string::npos);
  owner.kill();
  EXPECT_TRUE(fs::exists(file()));
  {
    const ArchiveLock lock(folder_.path());
    EXPECT_EQ(content()["pid"], getpid());
    EXPECT_TRUE(others().empty());
    EXPECT_NE(refusal(), "");
  }
  EXPECT_FALSE(fs::exists(file()));
}

TEST_F(ArchiveLockTest, AnotherBootsOrAnEarlierProcessesIsTakenOver) {
  ProcessIdentity owner = this_process();
  owner.boot_id = "another";
  leave(owner);
  EXPECT_EQ(refusal(), "");
  owner = this_process();
  --owner.started;
  leave(owner);
  EXPECT_EQ(refusal(), "");
}

TEST_F(ArchiveLockTest, AnotherHostsStays) {
  ProcessIdentity owner = this_process();
  owner.host = "another";
  owner.boot_id = "another";
  leave(owner);
  EXPECT_NE(refusal().find("on another has the archive since 2024-05-31T21:00:00Z"),
            std::string::npos)
      << refusal();
  EXPECT_NE(refusal().find("remove the file"), std::string::npos) << refusal();
  EXPECT_EQ(content()["host"], "another");
}

TEST_F(ArchiveLockTest, OneThatCannotBeReadStays) {
  for (const char* text : {"", "{", "{}", "\xff", "{\"host\":1}"}) {
    std::ofstream(file()) << text;
    EXPECT_NE(refusal().find("remove the file"), std::string::npos) << text;
    EXPECT_TRUE(fs::exists(file())) << text;
  }
}

TEST_F(ArchiveLockTest, RemovedByHandAndTakenByAnotherItIsTheOthers) {
  {
    const ArchiveLock lock(folder_.path());
    fs::remove(file());
    ProcessIdentity other = this_process();
    other.host = "another";
    leave(other);
  }
  EXPECT_TRUE(fs::exists(file()));
}

TEST_F(ArchiveLockTest, AProcessThatEndsAtOnceRemovesItsOwn) {
  remove_own_lock();  // there is none
  ArchiveLock lock(folder_.path());
  remove_own_lock();
  EXPECT_FALSE(fs::exists(folder_ / "lock"));
  ArchiveLock other(folder_.path());
  std::ofstream(folder_ / "lock") << "somebody else's";
  remove_own_lock();
  EXPECT_TRUE(fs::exists(folder_ / "lock"));
}

TEST_F(ArchiveLockTest, AForkedChildDoesNotFreeIt) {
  std::optional<ArchiveLock> lock(folder_.path());
  Child child([&](const Child::Say& say) {
    lock.reset();
    say('d');
  });
  EXPECT_EQ(child.heard(), 'd');
  EXPECT_TRUE(fs::exists(file()));
}

TEST_F(ArchiveLockTest, AnArchiveThatIsNotThereIsNoLockedOne) {
  try {
    const ArchiveLock lock(folder_ / "none");
    ADD_FAILURE() << "it was locked";
  } catch (const LockedError&) {
    ADD_FAILURE() << "it counts as another's";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), folder_ / "none/lock");
  }
}

/// Several processes try at once, over and over; inside, each makes and removes a file that two
/// could not both make. The lock they find first is free, or a dead process'.
void race(const fs::path& archive, bool dead_owner) {
  constexpr int kProcesses = 4;
  constexpr int kRounds = 200;
  const fs::path inside = archive / "inside";
  ProcessIdentity dead = this_process();
  --dead.started;
  const auto compete = [&](const Child::Say& say) {
    for (int taken = 0; taken < kRounds;) {
      try {
        const ArchiveLock lock(archive);
        ++taken;
        if (mkdir(inside.c_str(), 0777) != 0) say('!');
        rmdir(inside.c_str());
        if (!dead_owner) continue;
        // As if this process had died here: the others must agree on who is next.
        std::ofstream(archive / "dead") << nlohmann::json{{"host", dead.host},
                                                          {"pid", dead.pid},
                                                          {"boot_id", dead.boot_id},
                                                          {"process_started", dead.started},
                                                          {"since", "then"}};
        fs::rename(archive / "dead", archive / "lock");
      } catch (const LockedError&) {
      }
    }
    say('e');
  };
  std::vector<std::unique_ptr<Child>> children;
  for (int i = 0; i < kProcesses; ++i) children.push_back(std::make_unique<Child>(compete));
  for (const auto& child : children) EXPECT_EQ(child->heard(), 'e') << "two were inside at once";
}

TEST_F(ArchiveLockTest, OfSeveralAtOnceOneGetsAFreeArchive) {
  race(folder_.path(), false);
}

TEST_F(ArchiveLockTest, OfSeveralAtOnceOneTakesOverFromTheDead) {
  race(folder_.path(), true);
}

}  // namespace
}  // namespace semigeo::jobs
