#include "jobs/run/job_line.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "io/files/utf8.hpp"
#include "jobs/kinds/all_kinds.hpp"
#include "jobs/kinds/library.hpp"
#include "jobs/kinds/partition.hpp"
#include "jobs/kinds/recognise.hpp"
#include "jobs/kinds/surface.hpp"
#include "jobs/kinds/triplets.hpp"
#include "jobs/stages/library_job.hpp"
#include "jobs/stages/partition_job.hpp"
#include "jobs/stages/recognise_job.hpp"
#include "jobs/stages/surface_job.hpp"
#include "jobs/stages/triplets_job.hpp"
#include "tests/jobs/stages/unusual_parameters.hpp"

namespace semigeo::jobs {
namespace {

// Every field of what is sent, by position: one more or less in a struct, and this does not compile
// until it is listed here, and not pass until it is sent.

template <typename Visit, typename... Fields>
void visit_each(const Visit& visit, Fields&... fields) {
  (visit(fields), ...);
}

template <typename Result, typename Visit>
void every_field_of_result(Result& result, const Visit& visit) {
  auto& [format, vertices, triangles, parts, levels, repairs, quality, preparation, remeshed,
         vanished] = result;
  visit_each(visit, format, vertices, triangles, parts, levels, vanished);
  {
    auto& [surface, a, b, c, d, e, f, g, h, wrong] = repairs;
    visit(wrong);
    visit_each(visit, a, b, c, d, e, f, g, h);
    auto& [i, j, k, l, m, n, o, p, q] = surface;
    visit_each(visit, i, j, k, l, m, n, o, p, q);
  }
  {
    auto& [a, b, c, d, e] = quality;
    visit_each(visit, a, b, c, d, e);
  }
  {
    auto& [holes, a, b, c, d, tolerance, distance] = preparation;
    visit_each(visit, a, b, c, d, tolerance);
    auto& [loops, filled, outer, too_long, unsplittable] = holes;
    visit_each(visit, loops, filled, outer, too_long, unsplittable);
    auto& [maximum, sum, count] = distance;
    visit_each(visit, maximum, sum, count);
  }
  {
    auto& [a, b, c, d, e, f, g, h] = remeshed;
    visit_each(visit, a, b, c, d, e, f, g, h);
  }
}

template <typename Request, typename Visit>
void every_field_of_request(Request& request, const Visit& visit) {
  auto& [job, threads, memory_bytes, address_space_bytes, log] = request;
  visit_each(visit, threads, memory_bytes, address_space_bytes, log);
  auto& [kind, name, input, output, key, data] = job;
  visit_each(visit, name, input, output, key);
}

/// A value that no other field has.
class Distinct {
 public:
  template <typename Field>
  void operator()(Field& field) const {
    ++count_;
    if constexpr (std::is_same_v<Field, bool>) {
      field = true;
    } else if constexpr (std::is_integral_v<Field>) {
      field = static_cast<Field>(1000 + count_);
      if constexpr (sizeof(Field) == 8) field <<= 40;  // more than a double or an int holds
      field += static_cast<Field>(count_);
    } else if constexpr (std::is_floating_point_v<Field>) {
      field = 1.0 / (2.0 + count_);
    } else if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      field = {"b%\xff", "text " + std::to_string(count_)};
    } else {
      field = "text " + std::to_string(count_);
    }
  }

 private:
  mutable int count_ = 0;
};

/// All values, to be compared and to be printed.
class Listed {
 public:
  template <typename Field>
  void operator()(const Field& field) const {
    std::ostringstream text;
    text.precision(17);
    if constexpr (std::is_same_v<Field, std::vector<std::string>>) {
      for (const std::string& one : field) text << one << '\n';
    } else {
      text << field;
    }
    values.push_back(text.str());
  }
  mutable std::vector<std::string> values;
};

std::vector<std::string> values_of(const SurfaceJobResult& result) {
  Listed listed;
  every_field_of_result(result, listed);
  return listed.values;
}

std::vector<std::string> values_of(const JobRequest& request) {
  Listed listed;
  every_field_of_request(request, listed);
  listed.values.push_back(request.job.kind->words().kind);
  listed.values.push_back(request.job.kind->data_to_json(request.job).dump());
  return listed.values;
}

RecognitionParameters unusual_recognition() {
  return {.levels = 7, .most_features = 17, .torsion = false, .samples = 170, .least_reach = 0.17};
}

/// Jobs of every kind whose data differs from the default in every field.
std::vector<Job> unusual_jobs() {
  const std::vector<std::string> models = {"b%\xff", "c"};
  const auto job = [](const JobKind& kind, std::any data) {
    return Job{.kind = &kind, .name = {}, .input = {}, .output = {}, .key = {}, .data = data};
  };
  return {
      job(surface_kind(), SurfaceJobData{.input_name = "n",
                                         .input_xxh3 = "x",
                                         .parameters = unusual_parameters(),
                                         .sidecar_only = true}),
      job(triplets_kind(), TripletsJobData{unusual_recognition()}),
      job(partition_kind(), PartitionJobData{.models = models,
                                             .shapes = {.first = 3, .end = 5},
                                             .partitions = 7,
                                             .library = "/l\xff.h5",
                                             .parameters = unusual_recognition()}),
      job(library_kind(),
          LibraryJobData{.models = models, .partitions = 7, .parameters = unusual_recognition()}),
      job(recognise_kind(),
          RecogniseJobData{.input_name = "n",
                           .input_xxh3 = "x",
                           .library = "/l\xff.h5",
                           .library_digest = "d",
                           .parameters = unusual_recognition(),
                           .search = {.method = RecognitionMethod::kThesis, .min_score = 0.123}})};
}

Job plain_job() {
  Job job = unusual_jobs().front();
  job.data = SurfaceJobData{};
  return job;
}

TEST(JobLineTest, EveryFieldOfARequestArrives) {
  for (const Job& job : unusual_jobs()) {
    JobRequest sent;
    sent.job = job;
    every_field_of_request(sent, Distinct());
    const std::string line = to_line(sent);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_EQ(values_of(job_request_from(line, all_kinds())), values_of(sent));
  }
}

TEST(JobLineTest, DataOfEveryKindDiffersFromTheDefaultInEveryField) {
  for (const Job& job : unusual_jobs()) {
    const nlohmann::json sent = job.kind->data_to_json(job);
    const JobRequest read = job_request_from(to_line({.job = job, .log = {}}), all_kinds());
    EXPECT_EQ(job.kind->data_to_json(read.job), sent) << job.kind->words().kind;
    for (const auto& [name, value] : sent.items()) EXPECT_FALSE(value.empty()) << name;
  }
}

TEST(JobLineTest, PathsAreBytes) {
  JobRequest request;
  request.job = unusual_jobs().front();
  request.job.input = "/scans/Krug N\u00ba \xff\xfe/100%41\n.ply";
  request.job.output = "/archive \xc2/scans/a%.vtkhdf";
  request.log = "/archive \xc2/logs/\"\\\x01.log";
  const std::string line = to_line(request);
  EXPECT_TRUE(io::is_utf8(line));
  EXPECT_EQ(line.find('\n'), std::string::npos);
  const JobRequest read = job_request_from(line, all_kinds());
  EXPECT_EQ(read.job.input.native(), request.job.input.native());
  EXPECT_EQ(read.job.output.native(), request.job.output.native());
  EXPECT_EQ(read.log.native(), request.log.native());
}

TEST(JobLineTest, EveryFieldOfAResultArrives) {
  SurfaceJobResult filled;
  every_field_of_result(filled, Distinct());
  for (const SurfaceJobResult& result : {filled, SurfaceJobResult{}}) {
    const JobReply sent = {.kind = JobReply::Kind::kDone,
                           .worked = 123,
                           .result = surface_kind().result_to_json(result),
                           .cpu_seconds = 1.0 / 3,
                           .peak_bytes = 1e12 + 1};
    const std::string line = to_line(sent);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto [kind, worked, error, read, cpu_seconds, peak_bytes, last, write_error] =
        job_reply_from(line);
    EXPECT_FALSE(last);
    EXPECT_EQ(write_error, 0);
    EXPECT_EQ(kind, JobReply::Kind::kDone);
    EXPECT_EQ(worked, 123);
    EXPECT_EQ(error, "");
    EXPECT_EQ(cpu_seconds, 1.0 / 3);
    EXPECT_EQ(peak_bytes, 1e12 + 1);
    const std::any typed = surface_kind().result_from_json(read);
    EXPECT_EQ(values_of(std::any_cast<const SurfaceJobResult&>(typed)), values_of(result));
  }
}

template <typename Result>
Result after_a_line(const JobKind& kind, const Result& result) {
  const nlohmann::json sent = kind.result_to_json(result);
  const JobReply read = job_reply_from(to_line({.kind = JobReply::Kind::kDone, .result = sent}));
  return std::any_cast<Result>(kind.result_from_json(read.result));
}

TEST(JobLineTest, ResultsOfEveryKindArrive) {
  const auto [features, samples, count] =
      after_a_line(triplets_kind(), TripletsJobResult{.features = 1, .samples = 2, .triplets = 3});
  EXPECT_EQ(std::vector({features, samples, count}), (std::vector<std::int64_t>{1, 2, 3}));
  const auto partition =
      after_a_line(partition_kind(), PartitionJobResult{.postings = std::int64_t{1} << 40});
  EXPECT_EQ(partition.postings, std::int64_t{1} << 40);
  const auto [models, postings, digest] =
      after_a_line(library_kind(), LibraryJobResult{.models = 1, .postings = 2, .digest = "d"});
  EXPECT_EQ(std::vector({models, postings}), (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(digest, "d");
  const auto [found, looked_up, objects] = after_a_line(
      recognise_kind(), RecogniseJobResult{.features = 1, .triplets = 2, .objects = 3});
  EXPECT_EQ(std::vector({found, looked_up, objects}), (std::vector<std::int64_t>{1, 2, 3}));
}

TEST(JobLineTest, AJobMayBeDoneWithoutADataset) {
  const JobReply read = job_reply_from(to_line({.kind = JobReply::Kind::kDone, .result = {}}));
  EXPECT_EQ(read.kind, JobReply::Kind::kDone);
  EXPECT_TRUE(read.result.is_null());
}

TEST(JobLineTest, WorkIsNoOutcome) {
  const JobReply read = job_reply_from(to_line({.kind = JobReply::Kind::kWorked,
                                                .worked = std::int64_t{1} << 60,
                                                .error = {},
                                                .result = {}}));
  EXPECT_EQ(read.kind, JobReply::Kind::kWorked);
  EXPECT_EQ(read.worked, std::int64_t{1} << 60);
}

TEST(JobLineTest, AFailureSaysWhyWhateverTheReason) {
  const std::string name = "/Krug N\u00ba/a.ply: is \"no\" scan;\ntry \\ another";
  const JobReply read = job_reply_from(to_line({.kind = JobReply::Kind::kFailed,
                                                .worked = 7,
                                                .error = name,
                                                .result = {},
                                                .cpu_seconds = 0.5,
                                                .peak_bytes = 4096,
                                                .last = true,
                                                .write_error = ENOSPC}));
  EXPECT_TRUE(read.last);
  EXPECT_EQ(read.write_error, ENOSPC);
  EXPECT_EQ(read.kind, JobReply::Kind::kFailed);
  EXPECT_EQ(read.worked, 7);
  EXPECT_EQ(read.error, name);
  EXPECT_EQ(read.cpu_seconds, 0.5);
  EXPECT_EQ(read.peak_bytes, 4096);
  EXPECT_TRUE(read.result.is_null());
  // An error that names a file is what the file system says, and that may be no text.
  const JobReply bytes = job_reply_from(
      to_line({.kind = JobReply::Kind::kFailed, .error = "/a\xff: is no scan", .result = {}}));
  EXPECT_EQ(bytes.error, "/a\ufffd: is no scan");
}

TEST(JobLineTest, ALineThatIsNoneIsRefused) {
  for (const std::string line :
       {"", "{", "null", "[]", "7", "\"done\"", "{}", "\xff", "{\"worked\":\"much\"}",
        "{\"done\":null}", "{\"failed\":\"x\"}"}) {
    EXPECT_THROW(job_request_from(line, all_kinds()), std::runtime_error) << line;
    EXPECT_THROW(job_reply_from(line), std::runtime_error) << line;
  }
  // Each field is asked for.
  const nlohmann::json result = surface_kind().result_to_json(SurfaceJobResult{});
  const std::string request = to_line({.job = plain_job(), .log = {}});
  const std::string done = to_line({.kind = JobReply::Kind::kDone, .result = result});
  const auto renamed = [](std::string line, std::size_t quote) {
    return line.insert(quote + 1, "not ");
  };
  int names = 0;
  for (std::size_t at = 0; (at = request.find('"', at)) != std::string::npos; ++at) {
    const std::size_t end = request.find('"', at + 1);
    if (request[end + 1] == ':') {
      EXPECT_THROW(job_request_from(renamed(request, at), all_kinds()), std::runtime_error)
          << request.substr(at);
      ++names;
    }
    at = end;
  }
  EXPECT_GT(names, 10);
  for (std::size_t at = 0; (at = done.find('"', at)) != std::string::npos; ++at) {
    const std::size_t end = done.find('"', at + 1);
    if (done[end + 1] == ':' && done.compare(at, 6, "\"done\"") != 0)
      EXPECT_THROW(surface_kind().result_from_json(job_reply_from(renamed(done, at)).result),
                   std::exception)
          << done.substr(at);
    at = end;
  }
}

/// Values are copied and compared bracket by bracket, on the stack.
TEST(JobLineTest, BracketsDeepInEachOtherAreRefused) {
  const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
  const std::string reply =
      "{\"worked\":0,\"cpu_seconds\":0,\"peak_bytes\":0,\"done\":" + deep + "}";
  EXPECT_THROW(job_reply_from(reply), std::runtime_error);
  std::string request = to_line({.job = plain_job(), .log = {}});
  request.insert(1, "\"more\":" + deep + ",");
  EXPECT_THROW(job_request_from(request, all_kinds()), std::runtime_error);
}

}  // namespace
}  // namespace semigeo::jobs
