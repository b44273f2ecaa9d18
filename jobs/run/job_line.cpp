#include "jobs/run/job_line.hpp"

#include <stdexcept>
#include <utility>

#include "io/files/json_value.hpp"
#include "io/files/small_file.hpp"
#include "jobs/archive/path_text.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

/// Reads a line, and turns every error of JSON into the same error.
template <typename Read>
auto reading(const char* what, const std::string& line, const Read& read) {
  try {
    // Values are copied and compared bracket by bracket, so they must not be deep in each other.
    const json object = io::parse_json(line, {});
    if (object.is_discarded() && json::accept(line))
      throw std::runtime_error(std::string("is no ") + what + ": it is another kind of JSON");
    return read(object.is_discarded() ? json::parse(line) : object);
  } catch (const json::exception& e) {
    throw std::runtime_error(std::string("is no ") + what + ": " + e.what());
  }
}

}  // namespace

std::string to_line(const JobRequest& request) {
  const Job& job = request.job;
  return json{{"kind", job.kind->words().kind},
              {"name", escaped(job.name)},
              {"input", escaped(job.input.string())},
              {"output", escaped(job.output.string())},
              {"key", job.key},
              {"data", job.kind->data_to_json(job)},
              {"threads", request.threads},
              {"memory_bytes", request.memory_bytes},
              {"address_space_bytes", request.address_space_bytes},
              {"log", escaped(request.log.string())}}
      .dump();
}

JobRequest job_request_from(const std::string& line, const JobKinds& kinds) {
  return reading("job", line, [&](const json& object) {
    const auto text = [&](const char* name) {
      return unescaped(object.at(name).get<std::string>());
    };
    JobRequest request;
    Job& job = request.job;
    const auto kind = object.at("kind").get<std::string>();
    job.kind = kinds.find(kind);
    if (job.kind == nullptr) throw std::runtime_error("is no job: of no known kind: " + kind);
    job.name = text("name");
    job.input = text("input");
    job.output = text("output");
    object.at("key").get_to(job.key);
    job.data = job.kind->data_from_json(object.at("data"));
    io::read_value(object.at("threads"), request.threads);
    io::read_value(object.at("memory_bytes"), request.memory_bytes);
    io::read_value(object.at("address_space_bytes"), request.address_space_bytes);
    request.log = text("log");
    return request;
  });
}

std::string to_line(const JobReply& reply) {
  json object = {{"worked", reply.worked}};
  if (reply.kind != JobReply::Kind::kWorked) {
    object["cpu_seconds"] = reply.cpu_seconds;
    object["peak_bytes"] = reply.peak_bytes;
    if (reply.kind == JobReply::Kind::kDone) object["done"] = reply.result;
    if (reply.kind == JobReply::Kind::kFailed) object["failed"] = reply.error;
    if (reply.last) object["last"] = true;
    if (reply.write_error != 0) object["write_error"] = reply.write_error;
  }
  // What the file system says need not be UTF-8.
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

JobReply job_reply_from(const std::string& line) {
  return reading("answer of a job", line, [](const json& object) {
    JobReply reply;
    io::read_value(object.at("worked"), reply.worked);
    if (const auto failed = object.find("failed"); failed != object.end()) {
      failed->get_to(reply.error);
      if (const auto error = object.find("write_error"); error != object.end())
        io::read_value(*error, reply.write_error);
    } else if (const auto done = object.find("done"); done != object.end()) {
      reply.kind = JobReply::Kind::kDone;
      reply.result = *done;
    } else {
      reply.kind = JobReply::Kind::kWorked;
      return reply;
    }
    reply.last = object.value("last", false);
    object.at("cpu_seconds").get_to(reply.cpu_seconds);
    object.at("peak_bytes").get_to(reply.peak_bytes);
    return reply;
  });
}

}  // namespace semigeo::jobs
