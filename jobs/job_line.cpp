#include "jobs/job_line.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "jobs/path_text.hpp"

namespace semigeo::jobs {
namespace {

using nlohmann::json;

/// Names every number and word of a result, for writing and for reading alike.
template <typename Result, typename Visit>
void each_field(Result& r, const Visit& visit) {
  visit("format", r.format);
  visit("vertices", r.vertices);
  visit("triangles", r.triangles);
  visit("parts", r.parts);
  visit("levels", r.levels);
  visit("vanished", r.vanished);
  visit("welded_vertices", r.repairs.welded_vertices);
  visit("degenerate_faces", r.repairs.degenerate_faces);
  visit("duplicate_faces", r.repairs.duplicate_faces);
  visit("flipped_faces", r.repairs.flipped_faces);
  visit("nonmanifold_faces", r.repairs.nonmanifold_faces);
  visit("split_vertices", r.repairs.split_vertices);
  visit("isolated_vertices", r.repairs.isolated_vertices);
  visit("holes_loops", r.preparation.holes.loops);
  visit("holes_filled", r.preparation.holes.filled);
  visit("holes_outer", r.preparation.holes.outer);
  visit("holes_too_long", r.preparation.holes.too_long);
  visit("holes_unsplittable", r.preparation.holes.unsplittable);
  visit("filled_vertices", r.preparation.filled_vertices);
  visit("filled_faces", r.preparation.filled_faces);
  visit("removed_vertices", r.preparation.removed_vertices);
  visit("removed_faces", r.preparation.removed_faces);
  visit("tolerance", r.preparation.tolerance);
  visit("distance_maximum", r.preparation.distance.maximum);
  visit("distance_sum", r.preparation.distance.sum);
  visit("distance_count", r.preparation.distance.count);
  visit("flipped", r.remeshed.flipped);
  visit("split", r.remeshed.split);
  visit("collapsed", r.remeshed.collapsed);
  visit("torn", r.remeshed.torn);
  visit("inserted", r.remeshed.inserted);
  visit("removed", r.remeshed.removed);
  visit("dropped_parts", r.remeshed.dropped_parts);
  visit("dropped_faces", r.remeshed.dropped_faces);
}

json to_json_object(const SurfaceJobResult& result) {
  json object;
  each_field(result, [&](const char* name, const auto& value) { object[name] = value; });
  return object;
}

SurfaceJobResult result_from(const json& object) {
  SurfaceJobResult result;
  each_field(result, [&](const char* name, auto& value) { object.at(name).get_to(value); });
  return result;
}

/// Whatever JSON has against a line is the same failure.
template <typename Read>
auto reading(const char* what, const std::string& line, const Read& read) {
  try {
    return read(json::parse(line));
  } catch (const json::exception& e) {
    throw std::runtime_error(std::string("is no ") + what + ": " + e.what());
  }
}

}  // namespace

std::string to_line(const JobRequest& request) {
  const SurfaceJob& job = request.job;
  return json{{"input", escaped(job.input.string())},
              {"input_name", job.input_name},
              {"name", job.name},
              {"output", escaped(job.output.string())},
              {"input_xxh3", job.input_xxh3},
              {"key", job.key},
              {"parameters", json::parse(to_json(request.parameters))},
              {"sidecar_only", request.sidecar_only},
              {"threads", request.threads},
              {"memory_bytes", request.memory_bytes},
              {"log", escaped(request.log.string())}}
      .dump();
}

JobRequest job_request_from(const std::string& line) {
  return reading("job", line, [](const json& object) {
    JobRequest request;
    request.job.input = unescaped(object.at("input").get<std::string>());
    object.at("input_name").get_to(request.job.input_name);
    object.at("name").get_to(request.job.name);
    request.job.output = unescaped(object.at("output").get<std::string>());
    object.at("input_xxh3").get_to(request.job.input_xxh3);
    object.at("key").get_to(request.job.key);
    request.parameters = parameters_from_json(object.at("parameters").dump());
    object.at("sidecar_only").get_to(request.sidecar_only);
    object.at("threads").get_to(request.threads);
    object.at("memory_bytes").get_to(request.memory_bytes);
    request.log = unescaped(object.at("log").get<std::string>());
    return request;
  });
}

std::string to_line(const JobReply& reply) {
  switch (reply.kind) {
    case JobReply::Kind::kWorked:
      return json{{"worked", reply.worked}}.dump();
    case JobReply::Kind::kDone:
      return json{{"done", reply.result ? to_json_object(*reply.result) : json()},
                  {"worked", reply.worked},
                  {"cpu_seconds", reply.cpu_seconds},
                  {"peak_bytes", reply.peak_bytes}}
          .dump();
    case JobReply::Kind::kFailed:
      break;
  }
  // What the file system says need not be UTF-8.
  return json{{"failed", reply.error},
              {"worked", reply.worked},
              {"cpu_seconds", reply.cpu_seconds},
              {"peak_bytes", reply.peak_bytes}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

JobReply job_reply_from(const std::string& line) {
  return reading("answer of a job", line, [](const json& object) {
    JobReply reply;
    object.at("worked").get_to(reply.worked);
    if (const auto failed = object.find("failed"); failed != object.end()) {
      failed->get_to(reply.error);
    } else if (const auto done = object.find("done"); done != object.end()) {
      reply.kind = JobReply::Kind::kDone;
      if (!done->is_null()) reply.result = result_from(*done);
    } else {
      reply.kind = JobReply::Kind::kWorked;
      return reply;
    }
    object.at("cpu_seconds").get_to(reply.cpu_seconds);
    object.at("peak_bytes").get_to(reply.peak_bytes);
    return reply;
  });
}

}  // namespace semigeo::jobs
