#include "jobs/run/worker.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <optional>

#include "engine/child_process.hpp"
#include "engine/descriptor.hpp"
#include "io/dataset/dataset.hpp"
#include "jobs/kinds/all_kinds.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/run/job_line.hpp"
#include "tests/jobs/scans_to_run.hpp"
#include "tests/support/sanitizers.hpp"
#include "tests/support/scan_file.hpp"
#include "tests/support/shapes.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/test_faults.hpp"

namespace semigeo::jobs {
namespace {

namespace fs = std::filesystem;
using engine::ChildProcesses;

constexpr double kLong = 60;  // a test that waits so long has failed

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class WorkerTest : public testing::Test {
 protected:
  /// A job over a new scan, as a run would plan it.
  JobRequest request(const char* name, int subdivisions = 1) {
    tests::ScansToRun config;
    config.inputs = {tests::write_obj(folder_ / name, shapes::icosphere(subdivisions))};
    config.archive = folder_ / "archive";
    config.surface.levels = 1;
    fs::create_directories(folder_ / "archive/scans");
    return {.job = tests::plan_scans(config).front().job,
            .log = folder_ / "logs" / (std::string(name) + ".log")};
  }

  ChildProcesses::Id start() {
    return children_.start({.arguments = {SEMIGEO_PROGRAM, "job"},
                            .log = folder_ / "worker.log",
                            .append_to_log = true,
                            .converses = true});
  }

  /// The outcome of a job; nothing if the worker ended instead.
  std::optional<JobReply> reply() {
    worked_ = 0;
    for (;;) {
      const auto event = children_.wait(kLong);
      if (const auto* line = std::get_if<ChildProcesses::Line>(&event)) {
        const JobReply reply = job_reply_from(line->text);
        worked_ += reply.worked;
        if (reply.kind != JobReply::Kind::kWorked) return reply;
      } else {
        if (const auto* ended = std::get_if<ChildProcesses::Ended>(&event)) ended_ = *ended;
        return std::nullopt;
      }
    }
  }
  std::optional<JobReply> reply_to(ChildProcesses::Id worker, const JobRequest& request) {
    children_.send(worker, to_line(request));
    return reply();
  }

  tests::TemporaryFolder folder_;
  ChildProcesses children_;
  std::int64_t worked_ = 0;
  std::optional<ChildProcesses::Ended> ended_;
};

TEST_F(WorkerTest, DoesOneJobAfterTheOther) {
  const auto worker = start();
  const struct {
    const char* name;
    int subdivisions;
    std::int64_t vertices;
  } scans[] = {{"a.obj", 1, 42}, {"b.obj", 2, 162}, {"c.obj", 0, 12}};
  for (const auto& scan : scans) {
    const JobRequest wanted = request(scan.name, scan.subdivisions);
    const auto answer = reply_to(worker, wanted);
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->kind, JobReply::Kind::kDone);
    EXPECT_EQ(answer->error, "");
    ASSERT_FALSE(answer->result.is_null());
    EXPECT_EQ(answer->result.at("vertices"), scan.vertices);
    EXPECT_EQ(answer->result.at("format"), "OBJ");
    EXPECT_EQ(worked_, 2 * scan.vertices);
    EXPECT_GT(answer->cpu_seconds, 0);
    EXPECT_GT(answer->peak_bytes, 1e6);
    EXPECT_NO_THROW(io::Dataset(wanted.job.output).verify());
  }
  children_.close_input(worker);
  EXPECT_FALSE(reply().has_value());
  ASSERT_TRUE(ended_.has_value());
  EXPECT_EQ(ended_->exit_code, 0);
  EXPECT_EQ(contents(folder_ / "worker.log"), "");
}

TEST_F(WorkerTest, TheNumberOfASystemErrorIsAnswered) {
  const auto worker = start();
  const JobRequest lost = request("a.obj");
  fs::remove_all(lost.job.output.parent_path());
  const auto answer = reply_to(worker, lost);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->kind, JobReply::Kind::kFailed);
  EXPECT_EQ(answer->write_error, ENOENT);
  EXPECT_TRUE(answer->error.starts_with(lost.job.output.string() + ": ")) << answer->error;
  // What is wrong with a scan is no error of the archive.
  JobRequest gone = request("b.obj");
  fs::remove(gone.job.input);
  const auto refused = reply_to(worker, gone);
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->kind, JobReply::Kind::kFailed);
  EXPECT_EQ(refused->write_error, 0);
}

TEST_F(WorkerTest, WhatAJobThrowsIsItsFailure) {
  const auto worker = start();
  const JobRequest good = request("a.obj");
  JobRequest bad = request("b.obj");
  std::ofstream(bad.job.input) << "v 0 0 zero\n";
  const auto answer = reply_to(worker, bad);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->kind, JobReply::Kind::kFailed);
  EXPECT_TRUE(answer->error.starts_with(bad.job.input.string() + ": ")) << answer->error;
  EXPECT_FALSE(fs::exists(bad.job.output));
  const auto next = reply_to(worker, good);
  ASSERT_TRUE(next.has_value());
  EXPECT_EQ(next->kind, JobReply::Kind::kDone);
}

TEST_F(WorkerTest, AScanThatIsNotThePlannedOneFails) {
  const auto worker = start();
  const JobRequest wanted = request("a.obj");
  tests::write_obj(wanted.job.input, shapes::icosphere(1, 2));
  const auto answer = reply_to(worker, wanted);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->kind, JobReply::Kind::kFailed);
  EXPECT_NE(answer->error.find("changed"), std::string::npos) << answer->error;
  EXPECT_FALSE(fs::exists(wanted.job.output));
}

TEST_F(WorkerTest, WhatAJobPrintsGoesToItsLog) {
  const tests::TestFaults faults("b.obj=crash");
  const auto worker = start();
  const JobRequest silent = request("a.obj");
  const JobRequest loud = request("b.obj");
  ASSERT_TRUE(reply_to(worker, silent).has_value());
  EXPECT_EQ(contents(silent.log), "");  // nothing was printed
  fs::create_directories(loud.log.parent_path());
  std::ofstream(loud.log) << "before\n";
  EXPECT_FALSE(reply_to(worker, loud).has_value());
  ASSERT_TRUE(ended_.has_value());
  EXPECT_EQ(ended_->signal, SIGSEGV);
  EXPECT_EQ(contents(loud.log), "before\nabout to crash\n");
  EXPECT_FALSE(fs::exists(silent.log));
  EXPECT_EQ(contents(folder_ / "worker.log"), "");
}

TEST_F(WorkerTest, AnEmptyLogBecomesThatOfTheNextJob) {
  const auto worker = start();
  const JobRequest first = request("a.obj");
  const JobRequest second = request("b.obj");
  ASSERT_TRUE(reply_to(worker, first).has_value());
  ASSERT_TRUE(reply_to(worker, second).has_value());
  EXPECT_FALSE(fs::exists(first.log));
  EXPECT_TRUE(fs::exists(second.log));
}

TEST_F(WorkerTest, ALogThatCannotBeOpenedIsDoneWithout) {
  const auto worker = start();
  JobRequest wanted = request("a.obj");
  wanted.log = wanted.job.input / "below a file.log";
  const auto answer = reply_to(worker, wanted);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->kind, JobReply::Kind::kDone);
}

TEST_F(WorkerTest, ALineThatIsNoRequestEndsIt) {
  const auto worker = start();
  children_.send(worker, "{\"input\":\"a.ply\"}");
  EXPECT_FALSE(reply().has_value());
  ASSERT_TRUE(ended_.has_value());
  EXPECT_EQ(ended_->exit_code, 2);
  EXPECT_TRUE(contents(folder_ / "worker.log").starts_with("semigeo: a line is no job: "));
}

TEST_F(WorkerTest, MemoryBeyondTheLimitIsAFailureAndTheLastJobOfItsProcess) {
  if (tests::kSanitized) GTEST_SKIP() << "the address space is not limited";
  const tests::TestFaults faults("bomb.obj=memory");
  JobRequest bomb = request("bomb.obj");
  bomb.address_space_bytes = std::uint64_t{600} << 20;
  JobRequest good = request("good.obj", 3);
  good.address_space_bytes = bomb.address_space_bytes;
  for (int round = 0; round < 2; ++round) {
    const auto failed = reply_to(start(), bomb);
    ASSERT_TRUE(failed.has_value());
    EXPECT_EQ(failed->kind, JobReply::Kind::kFailed);
    EXPECT_TRUE(
        failed->error.starts_with(bomb.job.input.string() + ": needs more than the 600 MiB"))
        << failed->error;
    EXPECT_EQ(failed->error.find('\n'), std::string::npos);
    EXPECT_EQ(contents(bomb.log), "");
    // Libraries may be left half changed.
    EXPECT_TRUE(failed->last);
    EXPECT_FALSE(reply().has_value());
    EXPECT_EQ(ended_->exit_code, 0);
    const auto next = reply_to(start(), good);
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(next->kind, JobReply::Kind::kDone) << next->error;
    EXPECT_FALSE(next->last);
    EXPECT_LT(next->peak_bytes, failed->peak_bytes / 2);  // what the bomb took is not its
  }
}

TEST_F(WorkerTest, HoweverLittleMemoryThereIsTheFailureNamesTheScan) {
  if (tests::kSanitized) GTEST_SKIP() << "the address space is not limited";
  JobRequest wanted = request("a.obj", 5);
  wanted.threads = 2;  // the second needs room for its stack
  const std::string output = wanted.job.output.string();
  std::vector<std::uint64_t> kibibytes;
  for (std::uint64_t k = 16 << 10; k < 44 << 10; k += 4 << 10) kibibytes.push_back(k);
  // Enough for all but the last arrays, so that HDF5 is the one to miss it.
  for (std::uint64_t k = 44 << 10; k < 54 << 10; k += 256) kibibytes.push_back(k);
  for (const std::uint64_t k : kibibytes) {
    wanted.address_space_bytes = k << 10;
    fs::remove(output);
    const auto worker = start();  // what another job has left changes what is too little
    const auto answer = reply_to(worker, wanted);
    if (!answer) {
      // HDF5 itself may crash without memory; we do not.
      EXPECT_NE(ended_->signal, SIGABRT) << k << ' ' << contents(wanted.log);
      continue;
    }
    if (answer->kind == JobReply::Kind::kFailed) {
      EXPECT_TRUE(answer->error.starts_with(wanted.job.input.string() + ": ") ||
                  answer->error.starts_with(output + ": "))
          << k << ' ' << answer->error;
      EXPECT_NE(answer->error.find("memory"), std::string::npos) << answer->error;
      EXPECT_FALSE(fs::exists(output));
    }
    children_.kill(worker);
    EXPECT_FALSE(reply().has_value());
  }
  wanted.address_space_bytes = std::uint64_t{1} << 30;
  const auto answer = reply_to(start(), wanted);
  ASSERT_TRUE(answer.has_value());
  EXPECT_EQ(answer->kind, JobReply::Kind::kDone) << answer->error;
}

TEST_F(WorkerTest, ALostSidecarIsMadeAgainWithoutTheDataset) {
  const auto worker = start();
  JobRequest wanted = request("a.obj");
  ASSERT_TRUE(reply_to(worker, wanted).has_value());
  const fs::path sidecar = fs::path(wanted.job.output).replace_extension(".xdmf");
  const std::string text = contents(sidecar);
  ASSERT_FALSE(text.empty());
  fs::remove(sidecar);
  surface_data(wanted.job).sidecar_only = true;
  const auto made = reply_to(worker, wanted);
  ASSERT_TRUE(made.has_value());
  EXPECT_EQ(made->kind, JobReply::Kind::kDone);
  EXPECT_TRUE(made->result.is_null());
  EXPECT_EQ(contents(sidecar), text);
  // Without a dataset to make it from, that is made, too.
  fs::remove(sidecar);
  fs::remove(wanted.job.output);
  const auto both = reply_to(worker, wanted);
  ASSERT_TRUE(both.has_value());
  EXPECT_FALSE(both->result.is_null());
  EXPECT_EQ(contents(sidecar), text);
  EXPECT_TRUE(fs::exists(wanted.job.output));
}

TEST_F(WorkerTest, ByHandAnswersAreOnStandardOutput) {
  const JobRequest wanted = request("a.obj");
  std::ofstream(folder_ / "requests.jsonl") << to_line(wanted) << '\n';
  children_.start({.arguments = {"/bin/sh", "-c", "exec \"$0\" job < \"$1\"", SEMIGEO_PROGRAM,
                                 (folder_ / "requests.jsonl").string()},
                   .log = folder_ / "answers.jsonl"});
  EXPECT_FALSE(reply().has_value());
  ASSERT_TRUE(ended_.has_value());
  EXPECT_EQ(ended_->exit_code, 0);
  std::ifstream answers(folder_ / "answers.jsonl");
  std::string last;
  for (std::string line; std::getline(answers, line);) last = line;
  EXPECT_EQ(job_reply_from(last).kind, JobReply::Kind::kDone);
}

TEST_F(WorkerTest, RequestsMayComeInPieces) {
  const JobRequest wanted = request("a.obj");
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  engine::Descriptor ours(ends[0]);
  const engine::Descriptor theirs(ends[1]);
  const std::string line = to_line(wanted) + '\n';
  // Two requests in one piece and a half; what comes after the last newline is none.
  const std::string sent = line + line + "{\"half";
  ASSERT_EQ(write(ours.get(), sent.data(), sent.size()), static_cast<ssize_t>(sent.size()));
  shutdown(ours.get(), SHUT_WR);
  EXPECT_EQ(serve_jobs(theirs.get(), theirs.get(), all_kinds()), 0);
  shutdown(theirs.get(), SHUT_WR);
  std::string answers;
  char buffer[4096];
  for (ssize_t count; (count = read(ours.get(), buffer, sizeof buffer)) > 0;)
    answers.append(buffer, static_cast<std::size_t>(count));
  int done = 0;
  for (std::size_t at = 0; (at = answers.find("\"done\"", at)) != std::string::npos; ++at) ++done;
  EXPECT_EQ(done, 2);
}

}  // namespace
}  // namespace semigeo::jobs
