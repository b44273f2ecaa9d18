#include "jobs/archive/journal.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/files/error.hpp"
#include "io/files/file_digest.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/temporary_folder.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;

const JobEnded kDone = {.job = "surface a.ply",
                        .key = "0123",
                        .state = "done",
                        .error = "",
                        .format = "PLY",
                        .seconds = 1.25,
                        .cpu_seconds = 2.5,
                        .peak_bytes = 3e7,
                        .vertices = 1000,
                        .levels = 9,
                        .input_bytes = 38000,
                        .threads = 2};

class JournalTest : public testing::Test {
 protected:
  fs::path file() const { return folder_ / "journal.jsonl"; }
  std::string text() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void set_text(const std::string& text) { std::ofstream(file(), std::ios::binary) << text; }
  void write(const JournalEvent& event, const std::string& run = "r") {
    Journal(folder_.path(), run).write(event);
  }
  std::vector<JournalEntry> read() {
    std::vector<JournalEntry> entries;
    damaged_ =
        read_journal(folder_.path(), [&](const JournalEntry& entry) { entries.push_back(entry); });
    return entries;
  }

  tests::TemporaryFolder folder_;
  std::int64_t damaged_ = 0;
};

TEST_F(JournalTest, GivesBackEveryEvent) {
  const std::vector<JournalEvent> events = {
      RunStarted{
          .version = "0.1.0", .host = "h", .pid = 7, .threads = 2, .jobs = 3, .up_to_date = 4},
      JobStarted{.job = "surface a.ply", .key = "0123"}, kDone,
      JobEnded{.job = "surface b.ply",
               .key = "4",
               .state = "failed",
               .error = "b.ply: \"quotes\", \\ and\nnew lines",
               .format = ""},
      RunEnded{.done = 1, .up_to_date = 4, .failed = 1, .seconds = 0.1, .cpu_seconds = 0.2}};
  Journal journal(folder_.path(), "night 1");
  for (const auto& event : events) journal.write(event);
  const auto entries = read();
  ASSERT_EQ(entries.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(entries[i].event, events[i]) << i;
    EXPECT_EQ(entries[i].run, "night 1");
    EXPECT_EQ(entries[i].time.size(), 20u);
  }
  EXPECT_EQ(damaged_, 0);
}

TEST_F(JournalTest, ALineIsJsonThatBeginsWithTheChecksumOfItsRest) {
  write(kDone);
  const std::string line = text();
  ASSERT_EQ(std::ranges::count(line, '\n'), 1);
  ASSERT_TRUE(line.ends_with('\n'));
  const auto document = nlohmann::json::parse(line);
  EXPECT_EQ(document["event"], "ended");
  EXPECT_EQ(document["job"], "surface a.ply");
  EXPECT_EQ(document["vertices"], 1000);
  const std::string rest = line.substr(line.find("\"event\""));
  EXPECT_EQ(document["crc"], io::xxh3_of_text(rest.substr(0, rest.size() - 1)).substr(0, 8));
}

TEST_F(JournalTest, NoJournalIsAnEmptyOne) {
  EXPECT_TRUE(read().empty());
  set_text("");
  EXPECT_TRUE(read().empty());
  EXPECT_EQ(damaged_, 0);
}

TEST_F(JournalTest, AWrongBitAnywhereCostsItsLineOnly) {
  for (const char* run : {"1", "2", "3"}) write(kDone, run);
  const std::string whole = text();
  const std::size_t begin = whole.find('\n') + 1;
  const std::size_t end = whole.find('\n', begin);
  for (std::size_t at = begin; at < end; ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 4);  // none becomes a new line
    set_text(changed);
    const auto entries = read();
    ASSERT_EQ(entries.size(), 2u) << at;
    EXPECT_EQ(entries[0].run, "1");
    EXPECT_EQ(entries[1].run, "3");
    EXPECT_EQ(damaged_, 1);
  }
}

TEST_F(JournalTest, ATornLastLineIsPassedOverAndEndedBeforeTheNext) {
  write(kDone, "1");
  const std::string whole = text();
  for (std::size_t kept = 1; kept < whole.size(); ++kept) {
    set_text(whole + whole.substr(0, kept));
    const auto before = read();
    // What lacks nothing but its end is whole.
    EXPECT_EQ(before.size(), kept + 1 < whole.size() ? 1u : 2u) << kept;
    write(kDone, "2");
    const auto after = read();
    ASSERT_EQ(after.size(), before.size() + 1) << kept;
    EXPECT_EQ(after.back().run, "2");
  }
}

TEST_F(JournalTest, OnlyTheEndOfALongOneIsRead) {
  std::vector<std::size_t> ends = {0};
  for (int i = 0; i < 4; ++i) {
    write(JobStarted{.job = "surface " + std::to_string(i), .key = "k"});
    ends.push_back(text().size());
  }
  // Wherever the end begins, every line that is wholly in it is read.
  for (std::size_t bytes = 0; bytes <= ends.back() + 1; ++bytes) {
    std::vector<std::string> jobs;
    const auto damaged = read_journal(
        folder_.path(),
        [&](const JournalEntry& entry) { jobs.push_back(std::get<JobStarted>(entry.event).job); },
        static_cast<std::int64_t>(bytes));
    const auto whole = std::ranges::count_if(
        ends, [&](std::size_t end) { return end < ends.back() && end + bytes >= ends.back(); });
    EXPECT_EQ(std::ssize(jobs), whole) << bytes;
    if (!jobs.empty()) EXPECT_EQ(jobs.back(), "surface 3");
    EXPECT_EQ(damaged, 0) << bytes;
  }
}

TEST_F(JournalTest, NonsenseIsCountedAndPassedOver) {
  write(kDone, "1");
  const std::string line = text();
  set_text("\n\n" + std::string(1'000'000, 'x') + "\n{}\n" + std::string(5, '\0') + "\n[1]\n\n" +
           line + "{\"crc\":\"00000000\",\"event\":\"ended\"}\n\xff\xfe\n" + line +
           std::string(200'000, 'y'));
  const auto entries = read();
  EXPECT_EQ(entries.size(), 2u);
  EXPECT_EQ(damaged_, 7);
}

/// A line with the right checksum.
std::string checked(const std::string& rest) {
  return "{\"crc\":\"" + io::xxh3_of_text(rest).substr(0, 8) + "\"," + rest + "\n";
}

TEST_F(JournalTest, EventsOfLaterVersionsAreNoDamage) {
  set_text(checked(R"("event":"rested","time":"t","run":"r"})") +
           checked(R"("event":"started","job":"surface a","extra":[1],"time":"t","run":"r"})") +
           checked(R"("event":"started","job":7,"time":"t","run":"r"})") + checked("\"nonsense"));
  const auto entries = read();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].event, JournalEvent(JobStarted{.job = "surface a", .key = ""}));
  EXPECT_EQ(damaged_, 2);
}

TEST_F(JournalTest, NamesThatAreNoUtf8AndEndlessErrorsAreWritten) {
  JobEnded event = kDone;
  event.job = "surface \xff.ply";
  event.error = std::string(1'000'000, '\xfe');
  write(event);
  const auto entries = read();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(std::get<JobEnded>(entries[0].event).job, "surface \uFFFD.ply");
  EXPECT_EQ(damaged_, 0);
}

TEST_F(JournalTest, AFullDiskIsAnErrorAndHarmsNoLaterLine) {
  Journal journal(folder_.path(), "r");
  journal.write(kDone);
  {
    const tests::FileSizeLimit limit(text().size() + 40);
    EXPECT_THROW(journal.write(kDone), io::Error);
    EXPECT_THROW(journal.write(kDone), io::Error);
  }
  journal.write(kDone);
  EXPECT_EQ(read().size(), 2u);
  EXPECT_EQ(damaged_, 1);
}

TEST_F(JournalTest, LinesOfSeveralProcessesStandWhole) {
  constexpr int kProcesses = 4;
  constexpr int kLines = 500;
  std::vector<pid_t> children;
  for (int i = 0; i < kProcesses; ++i) {
    children.push_back(fork());
    if (children.back() != 0) continue;
    Journal journal(folder_.path(), std::to_string(i));
    for (int k = 0; k < kLines; ++k) journal.write(kDone);
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }
  EXPECT_EQ(read().size(), std::size_t{kProcesses} * kLines);
  EXPECT_EQ(damaged_, 0);
}

TEST_F(JournalTest, ALinkIsNotFollowed) {
  std::ofstream(folder_ / "elsewhere").flush();
  fs::create_symlink(folder_ / "elsewhere", file());
  EXPECT_THROW(write(kDone), io::Error);
  EXPECT_EQ(fs::file_size(folder_ / "elsewhere"), 0u);
}

TEST_F(JournalTest, OneThatCannotBeOpenedIsNamed) {
  fs::create_directory(file());
  try {
    write(kDone);
    ADD_FAILURE() << "it was opened";
  } catch (const io::Error& error) {
    EXPECT_EQ(error.file(), file());
  }
  EXPECT_THROW(read(), io::Error);
}

}  // namespace
}  // namespace semigeo::jobs
